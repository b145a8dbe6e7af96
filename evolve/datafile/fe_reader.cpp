#include "evolve/datafile/fe_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/nearest_name.h"

namespace meniscus::datafile {

namespace {

constexpr int kMatrix = 16;  // entries of a view matrix

// Read and left out: views, speeds, sizes; with how many numbers behind.
const std::map<std::string, int, std::less<>>& without_effect() {
  static const std::map<std::string, int, std::less<>> words = {
      {"soapfilm", 0},
      {"linear", 0},
      {"keep_originals", 0},
      {"keep_macros", 0},
      {"merit_factor", 0},
      {"interp_bdry_param", 0},
      {"everything_quantities", 0},
      {"vertices_predicted", 1},
      {"edges_predicted", 1},
      {"facets_predicted", 1},
      {"bodies_predicted", 1},
      {"facetedges_predicted", 1},
      {"quantities_predicted", 1},
      {"method_instances_predicted", 1},
      {"scale", 1},
      {"scale_limit", 1},
      {"constraint_tolerance", 1},
      {"total_time", 1},
      {"zoom_vertex", 1},
      {"zoom_radius", 1},
      {"suppress_warning", 1},
      {"unsuppress_warning", 1},
      {"view_matrix", kMatrix},
  };
  return words;
}

const std::map<std::string, std::string, std::less<>>& unsupported() {
  static const std::map<std::string, std::string, std::less<>> words = {
      {"string", "the string model"},
      {"simplex_representation", "the simplex model"},
      {"quadratic", "the quadratic model"},
      {"lagrange", "the Lagrange model"},
      {"torus", "a periodic domain"},
      {"torus_filled", "a periodic domain"},
      {"torus_periods", "a periodic domain"},
      {"periods", "a periodic domain"},
      {"display_periods", "a periodic domain"},
      {"symmetry_group", "a symmetry group"},
      {"metric", "a metric"},
      {"conformal_metric", "a metric"},
      {"klein_metric", "a metric"},
      {"wulff", "a crystalline integrand"},
      {"phasefile", "a phase file"},
      {"diffusion", "diffusion"},
      {"pressure", "the ideal gas model"},
      {"mobility", "a mobility"},
      {"mobility_tensor", "a mobility"},
      {"squared_curvature", "squared curvature"},
      {"mean_curvature_integral", "an integral of mean curvature"},
      {"squared_gaussian_curvature", "squared Gaussian curvature"},
      {"square_gaussian_curvature", "squared Gaussian curvature"},
      {"sqgauss", "squared Gaussian curvature"},
      {"optimizing_parameter", "a parameter that is optimised"},
      {"optimising_parameter", "a parameter that is optimised"},
      {"load_library", "a library of compiled functions"},
      {"length_method_name", "another measure of length"},
      {"hessian_special_normal_vector", "a special normal"},
      {"function", "a function"},
      {"procedure", "a procedure"},
  };
  return words;
}

}  // namespace

FeReader::FeReader(std::string_view text, const std::string& name)
    : lexer_(text, name) {
  file_.name = name;
}

FeFile FeReader::read() {
  top_section();
  vertices();
  edges();
  faces();
  bodies();
  if (lexer_.peek().is_name("read")) {
    file_.commands = lexer_.rest();
    file_.commands_line = lexer_.peek().place.line;
  } else if (lexer_.peek().kind != FeToken::Kind::End) {
    lexer_.fail_here("the section 'read' or the end is expected");
  }
  return std::move(file_);
}

void FeReader::top_section() {
  for (skip_separators(); !lexer_.peek().is_name("vertices");
       skip_separators()) {
    declaration();
  }
}

void FeReader::declaration() {
  if (lexer_.peek().kind == FeToken::Kind::End) {
    lexer_.fail_here("the section 'vertices' is missing");
  }
  if (lexer_.peek().kind != FeToken::Kind::Name) {
    lexer_.fail_here(
        "a keyword is expected (a '-' behind a space and right before its "
        "number begins a new expression: put spaces on both sides)");
  }
  const FeToken keyword = lexer_.take();
  const std::string& word = keyword.text;
  if (word == "parameter") {
    parameter();
  } else if (word == "boundary") {
    boundary();
  } else if (word == "constraint") {
    constraint();
  } else if (word == "quantity") {
    quantity(keyword.place);
  } else if (word == "method_instance") {
    method_instance(keyword.place);
  } else if (word == "define") {
    attribute();
  } else if (word == "gravity_constant") {
    skip_separators();
    file_.gravity = constant();
  } else if (word == "gap_constant" || word == "spring_constant") {
    skip_separators();
    file_.gap_constant = constant();
  } else if (word == "symmetric_content") {
    file_.symmetric_content = true;
  } else if (word == "integral_order_1d") {
    integral_order(keyword.place);
  } else if (!ignored(word)) {
    refuse(keyword);
  }
}

bool FeReader::ignored(const std::string& keyword) {
  int numbers = 0;
  if (const auto found = without_effect().find(keyword);
      found != without_effect().end()) {
    numbers = found->second;
  } else if (keyword == "view_transforms" ||
             keyword == "view_transform_generators") {
    skip_separators();
    const int matrices = integer("the number of matrices");
    for (int k = 0; k < matrices; ++k) {
      for (skip_separators(); lexer_.peek().is_name("color") ||
                              lexer_.peek().is_name("swap_colors");
           skip_separators()) {
        if (lexer_.take().text == "color") {
          constant();
        }
      }
      for (int entry = 0; entry < kMatrix; ++entry) {
        skip_separators();
        constant();
      }
    }
  } else if (keyword == "slice_coeff" || keyword == "clip_coeff") {
    accept("=");
    int depth = 0;
    do {
      const FeToken token = lexer_.take();
      depth += token.is("{") ? 1 : token.is("}") ? -1 : 0;
      if (token.kind == FeToken::Kind::End) {
        lexer_.fail(token.place, "'}' is missing");
      }
    } while (depth > 0);
  } else if (keyword == "evolver_version") {
    string("a version");
  } else {
    return false;
  }
  for (int k = 0; k < numbers; ++k) {
    skip_separators();
    constant();
  }
  return true;
}

// Throws, but for a declaration of what holds anyhow.
void FeReader::refuse(const FeToken& keyword) {
  const std::string& word = keyword.text;
  if (word == "surface_dimension" || word == "space_dimension") {
    skip_separators();
    const int wanted = word == "surface_dimension" ? 2 : 3;
    if (integer("a dimension") != wanted) {
      lexer_.fail(keyword.place,
                  fmt::format("{}: only {} is supported", word, wanted));
    }
    return;
  }
  if (word == "area_method_name" || word == "volume_method_name") {
    const std::string method = string("a method");
    if (method != "facet_area" && method != "facet_volume") {
      lexer_.fail(keyword.place,
                  fmt::format("{} \"{}\" is not supported", word, method));
    }
    return;
  }
  if (const auto found = unsupported().find(word);
      found != unsupported().end()) {
    lexer_.fail(keyword.place,
                fmt::format("'{}': {} is not supported", word, found->second));
  }
  std::vector<std::string> known = {
      "parameter",        "boundary",     "constraint",
      "quantity",         "define",       "method_instance",
      "gravity_constant", "gap_constant", "symmetric_content",
      "vertices"};
  for (const auto& [name, numbers] : without_effect()) {
    known.push_back(name);
  }
  const std::string near = nearest_name(word, known);
  lexer_.fail(keyword.place,
              fmt::format("unknown keyword '{}'{}", word,
                          near.empty() ? "" : "; is '" + near + "' meant?"));
}

void FeReader::integral_order(const FePlace& place) {
  constexpr int kHighest = 19;
  skip_separators();
  file_.line_order = integer("an order");
  if (file_.line_order < 1 || file_.line_order > kHighest) {
    lexer_.fail(place, fmt::format("integral_order_1d is {}; it must be 1 to "
                                   "{}",
                                   file_.line_order, kHighest));
  }
}

std::string FeReader::declared_name(const char* what) {
  skip_separators();
  const FeToken& token = lexer_.peek();
  if (token.kind != FeToken::Kind::Name) {
    lexer_.fail_here(fmt::format("the name of {} is expected", what));
  }
  static const std::set<std::string> kTaken = {"x",  "y",  "z",  "x1", "x2",
                                               "x3", "p1", "pi", "g"};
  if (kTaken.count(token.text) != 0) {
    lexer_.fail_here("this name has a meaning already");
  }
  return lexer_.take().text;
}

void FeReader::parameter() {
  FeParameter made;
  made.place = lexer_.peek().place;
  made.name = declared_name("a parameter");
  accept("=");
  made.value = constant();
  parameters_.insert(made.name);
  file_.parameters.push_back(std::move(made));
}

// define edge attribute NAME real
void FeReader::attribute() {
  static const std::map<std::string, FeElement, std::less<>> kElements = {
      {"vertex", FeElement::Vertices},
      {"edge", FeElement::Edges},
      {"facet", FeElement::Facets},
      {"body", FeElement::Bodies}};
  const FeToken element = lexer_.take();
  const auto found = kElements.find(element.text);
  if (found == kElements.end() || !lexer_.peek().is_name("attribute")) {
    lexer_.fail(element.place,
                "only 'define vertex|edge|facet|body attribute "
                "NAME real|integer' is supported");
  }
  lexer_.take();
  FeAttribute made;
  made.element = found->second;
  const FePlace place = lexer_.peek().place;
  made.name = declared_name("an attribute");
  const FeToken type = lexer_.take();
  if (type.text != "real" && type.text != "integer" && type.text != "ulong") {
    lexer_.fail(type.place, "the attribute's type is expected: real, integer");
  }
  if (lexer_.peek().is("[") || lexer_.peek().is_name("function")) {
    lexer_.fail_here("attributes are single numbers");
  }
  if (attribute_index(made.element, made.name) >= 0) {
    lexer_.fail(place,
                fmt::format("attribute '{}' is declared twice", made.name));
  }
  file_.attributes.push_back(std::move(made));
}

void FeReader::boundary() {
  FeBoundary made;
  made.place = lexer_.peek().place;
  made.name = lexer_.peek().kind == FeToken::Kind::Number
                  ? std::to_string(integer("a boundary's number"))
                  : declared_name("a boundary");
  if (!lexer_.peek().is_name("parameters") &&
      !lexer_.peek().is_name("parameter")) {
    lexer_.fail_here("'PARAMETERS 1' is expected");
  }
  lexer_.take();
  const FePlace place = lexer_.peek().place;
  if (integer("a number of parameters") != 1) {
    lexer_.fail(place,
                "only boundaries of one parameter are supported: films "
                "are held by curves; say surfaces as constraints");
  }
  for (skip_separators(); lexer_.peek().is_name("convex"); skip_separators()) {
    made.integrals.convex = true;
    lexer_.take();
  }
  made.coordinates = field("x", Sees::Parameter);
  integrals(made.integrals);
  if (!boundary_.emplace(made.name, static_cast<int>(file_.boundaries.size()))
           .second) {
    lexer_.fail(made.place,
                fmt::format("boundary {} is declared twice", made.name));
  }
  file_.boundaries.push_back(std::move(made));
}

void FeReader::constraint() {
  FeConstraint made;
  made.place = lexer_.peek().place;
  made.name = lexer_.peek().kind == FeToken::Kind::Number
                  ? std::to_string(integer("a constraint's number"))
                  : declared_name("a constraint");
  for (skip_separators();; skip_separators()) {
    const FeToken token = lexer_.take();
    if (token.is_name("convex")) {
      made.integrals.convex = true;
    } else if (token.is_name("global")) {
      made.global = true;
    } else if (token.is_name("nonnegative")) {
      made.side = FeConstraint::Side::Nonnegative;
    } else if (token.is_name("nonpositive")) {
      made.side = FeConstraint::Side::Nonpositive;
    } else if (token.is_name("nonwall")) {
      continue;  // for popping only
    } else if (token.is_name("formula") || token.is_name("function") ||
               token.is_name("equation")) {
      break;
    } else {
      lexer_.fail(token.place, fmt::format("'formula:' is expected in "
                                           "constraint {}, found '{}'",
                                           made.name, token.text));
    }
  }
  skip_separators();
  made.formula = formula(Sees::Place);
  integrals(made.integrals);
  if (!constraint_
           .emplace(made.name, static_cast<int>(file_.constraints.size()))
           .second) {
    lexer_.fail(made.place,
                fmt::format("constraint {} is declared twice", made.name));
  }
  file_.constraints.push_back(std::move(made));
}

void FeReader::integrals(FeIntegrals& integrals) {
  for (skip_separators();
       lexer_.peek().is_name("energy") || lexer_.peek().is_name("content");
       skip_separators()) {
    const FeToken keyword = lexer_.take();
    const bool energy = keyword.text == "energy";
    auto& target = energy ? integrals.energy : integrals.content;
    if (target) {
      lexer_.fail(keyword.place,
                  fmt::format("a second '{}' here", keyword.text));
    }
    target = field(energy ? "e" : "c", Sees::Place, FeElement::Edges);
  }
}

FeFile read_fe(std::string_view text, const std::string& name) {
  return FeReader(text, name).read();
}

}  // namespace meniscus::datafile
