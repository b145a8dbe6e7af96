#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/nearest_name.h"
#include "evolve/datafile/fe_reader.h"

namespace meniscus::datafile {

namespace {

// Behind these one number follows that changes no film.
const std::set<std::string, std::less<>>& numbers_without_effect() {
  static const std::set<std::string, std::less<>> words = {
      "original", "color", "frontcolor", "backcolor", "opacity"};
  return words;
}

const std::set<std::string, std::less<>>& words_without_effect() {
  static const std::set<std::string, std::less<>> words = {"bare", "nodisplay"};
  return words;
}

const std::set<std::string, std::less<>>& marks() {
  static const std::set<std::string, std::less<>> words = {
      "fixed",       "no_refine", "boundary", "constraint",
      "constraints", "bare",      "original"};
  return words;
}

}  // namespace

bool FeReader::starts_element() {
  skip_separators();
  return lexer_.peek().kind == FeToken::Kind::Number;
}

bool FeReader::on_line() {
  while (!lexer_.peek().first_on_line &&
         (lexer_.peek().is(",") || lexer_.peek().is(":") ||
          lexer_.peek().is(";"))) {
    lexer_.take();
  }
  return !lexer_.peek().first_on_line;
}

int FeReader::element_number(const char* what) {
  const FeToken token = lexer_.peek();
  const int number = integer(what);
  if (number <= 0) {
    lexer_.fail(token.place,
                fmt::format("{} is {}; it must be above 0", what, number));
  }
  return number;
}

// +(index + 1) or -(index + 1).
int FeReader::reference(const std::unordered_map<int, int>& ids,
                        const char* what) {
  const FePlace place = lexer_.peek().place;
  const int number = integer(what);
  const auto found = ids.find(std::abs(number));
  if (found == ids.end()) {
    lexer_.fail(place,
                fmt::format("{} {} is not defined", what, std::abs(number)));
  }
  return number < 0 ? -(found->second + 1) : found->second + 1;
}

void FeReader::vertices() {
  lexer_.take();
  while (starts_element()) {
    vertex();
  }
}

void FeReader::vertex() {
  FeVertex made;
  made.marks.place = lexer_.peek().place;
  made.id = element_number("a vertex's number");
  constexpr std::size_t kSpace = 3;
  while (made.coordinates.size() < kSpace && on_line() &&
         !(lexer_.peek().kind == FeToken::Kind::Name &&
           marks().count(lexer_.peek().text) != 0)) {
    made.coordinates.push_back(constant());
  }
  while (on_line()) {
    if (!mark(FeElement::Vertices, made.marks)) {
      unknown_mark("vertex");
    }
  }
  const std::size_t wanted = made.marks.boundary < 0 ? kSpace : 1;
  if (made.coordinates.size() != wanted) {
    lexer_.fail(made.marks.place,
                fmt::format("vertex {} has {} coordinates of {}", made.id,
                            made.coordinates.size(), wanted));
  }
  if (made.marks.boundary >= 0 && !made.marks.constraints.empty()) {
    lexer_.fail(
        made.marks.place,
        fmt::format("vertex {} is on a boundary and on a constraint", made.id));
  }
  if (!vertex_.emplace(made.id, static_cast<int>(file_.vertices.size()))
           .second) {
    lexer_.fail(made.marks.place,
                fmt::format("vertex {} is defined twice", made.id));
  }
  file_.vertices.push_back(std::move(made));
}

void FeReader::edges() {
  if (!lexer_.peek().is_name("edges")) {
    lexer_.fail_here("the section 'edges' is expected");
  }
  lexer_.take();
  while (starts_element()) {
    edge();
  }
}

void FeReader::edge() {
  FeEdge made;
  made.marks.place = lexer_.peek().place;
  made.id = element_number("an edge's number");
  made.tail = reference(vertex_, "vertex") - 1;
  made.head = reference(vertex_, "vertex") - 1;
  if (made.tail < 0 || made.head < 0 || made.tail == made.head) {
    lexer_.fail(made.marks.place,
                fmt::format("edge {} needs two different vertices", made.id));
  }
  while (on_line()) {
    if (lexer_.peek().is_name("tension")) {
      const FePlace place = lexer_.take().place;
      const FeExpression tension = constant();
      if (!tension.is_number() || tension.number != 0.0) {
        lexer_.fail(place, fmt::format("edge {}: edges with tension are not "
                                       "supported",
                                       made.id));
      }
    } else if (!mark(FeElement::Edges, made.marks)) {
      unknown_mark("edge");
    }
  }
  if (!edge_.emplace(made.id, static_cast<int>(file_.edges.size())).second) {
    lexer_.fail(made.marks.place,
                fmt::format("edge {} is defined twice", made.id));
  }
  file_.edges.push_back(std::move(made));
}

void FeReader::faces() {
  if (!lexer_.peek().is_name("faces") && !lexer_.peek().is_name("facets")) {
    lexer_.fail_here("the section 'faces' is expected");
  }
  lexer_.take();
  while (starts_element()) {
    face();
  }
}

void FeReader::face() {
  FeFace made;
  made.marks.place = lexer_.peek().place;
  made.id = element_number("a face's number");
  while (on_line() && signed_integer_ahead()) {
    made.edges.push_back(reference(edge_, "edge"));
  }
  check_loop(made);
  while (on_line()) {
    if (lexer_.peek().is_name("tension") || lexer_.peek().is_name("density")) {
      lexer_.take();
      made.tension = constant();
    } else if (lexer_.peek().is_name("color")) {
      lexer_.take();
      on_line();
      made.color = constant();
    } else if (!mark(FeElement::Facets, made.marks)) {
      unknown_mark("face");
    }
  }
  if (made.marks.boundary >= 0) {
    lexer_.fail(
        made.marks.place,
        fmt::format("face {}: faces on boundaries are not supported", made.id));
  }
  if (!face_.emplace(made.id, static_cast<int>(file_.faces.size())).second) {
    lexer_.fail(made.marks.place,
                fmt::format("face {} is defined twice", made.id));
  }
  file_.faces.push_back(std::move(made));
}

void FeReader::check_loop(const FeFace& face) {
  if (face.edges.size() < 3) {
    lexer_.fail(face.marks.place, fmt::format("face {} has {} edges; at least "
                                              "3 are needed",
                                              face.id, face.edges.size()));
  }
  for (std::size_t k = 0; k < face.edges.size(); ++k) {
    const int here = face.edges[k];
    const int next = face.edges[(k + 1) % face.edges.size()];
    const FeEdge& from = file_.edges[std::abs(here) - 1];
    const FeEdge& to = file_.edges[std::abs(next) - 1];
    const int end = here > 0 ? from.head : from.tail;
    const int start = next > 0 ? to.tail : to.head;
    if (end != start) {
      lexer_.fail(
          face.marks.place,
          fmt::format("face {} does not close: edge {}{} ends at vertex {}, "
                      "edge {}{} starts at vertex {}",
                      face.id, here < 0 ? "-" : "", from.id,
                      file_.vertices[end].id, next < 0 ? "-" : "", to.id,
                      file_.vertices[start].id));
    }
  }
}

void FeReader::bodies() {
  if (!lexer_.peek().is_name("bodies")) {
    return;
  }
  lexer_.take();
  while (starts_element()) {
    body();
  }
}

void FeReader::body() {
  FeBody made;
  made.place = lexer_.peek().place;
  made.id = element_number("a body's number");
  while (on_line() && signed_integer_ahead()) {
    made.faces.push_back(reference(face_, "face"));
  }
  while (on_line()) {
    if (!body_attribute(made)) {
      unknown_mark("body");
    }
  }
  if (made.volume && made.pressure) {
    lexer_.fail(made.place, fmt::format("body {} has a volume and a pressure; "
                                        "one of them follows from the other",
                                        made.id));
  }
  if (!body_.insert(made.id).second) {
    lexer_.fail(made.place, fmt::format("body {} is defined twice", made.id));
  }
  file_.bodies.push_back(std::move(made));
}

bool FeReader::body_attribute(FeBody& body) {
  const FeToken& token = lexer_.peek();
  if (token.kind != FeToken::Kind::Name) {
    return false;
  }
  if (token.text == "centerofmass") {
    lexer_.take();
    return true;
  }
  if (token.text == "lagrange_multiplier" || token.text == "original") {
    lexer_.take();
    skip_separators();
    constant();
    return true;
  }
  std::optional<FeExpression>* target =
      token.text == "volume"     ? &body.volume
      : token.text == "pressure" ? &body.pressure
      : token.text == "volconst" ? &body.volconst
      : token.text == "density"  ? &body.density
                                 : nullptr;
  if (target == nullptr) {
    FeMarks marks;
    return own_attribute(FeElement::Bodies, marks);
  }
  lexer_.take();
  on_line();
  *target = constant();
  return true;
}

bool FeReader::mark(FeElement element, FeMarks& marks) {
  const FeToken& token = lexer_.peek();
  if (token.kind != FeToken::Kind::Name) {
    return false;
  }
  if (token.text == "fixed") {
    lexer_.take();
    marks.fixed = true;
  } else if (token.text == "no_refine" && element != FeElement::Vertices) {
    lexer_.take();
    marks.no_refine = true;
  } else if (words_without_effect().count(token.text) != 0) {
    lexer_.take();
  } else if (numbers_without_effect().count(token.text) != 0) {
    lexer_.take();
    on_line();
    constant();
  } else if (token.text == "boundary") {
    on_boundary(marks);
  } else if (token.text == "constraint" || token.text == "constraints") {
    on_constraints(marks);
  } else {
    return own_attribute(element, marks) || own_quantity(element, marks);
  }
  return true;
}

void FeReader::on_boundary(FeMarks& marks) {
  lexer_.take();
  on_line();
  const FeToken token = lexer_.take();
  const auto found = boundary_.find(token.text);
  if (found == boundary_.end()) {
    lexer_.fail(token.place,
                fmt::format("boundary '{}' is not defined", token.text));
  }
  marks.boundary = found->second;
}

// One or more numbers or names, perhaps with a sign.
void FeReader::on_constraints(FeMarks& marks) {
  lexer_.take();
  const std::size_t before = marks.constraints.size();
  while (on_line()) {
    const bool name = lexer_.peek().kind == FeToken::Kind::Name &&
                      constraint_.count(lexer_.peek().text) != 0;
    if (!name && !signed_integer_ahead()) {
      break;
    }
    const FePlace place = lexer_.peek().place;
    const int sign_and_number = name ? 1 : integer("constraint");
    const std::string key =
        name ? lexer_.take().text : std::to_string(std::abs(sign_and_number));
    const auto found = constraint_.find(key);
    if (found == constraint_.end()) {
      lexer_.fail(place, fmt::format("constraint {} is not defined", key));
    }
    marks.constraints.push_back({found->second, sign_and_number < 0});
  }
  if (marks.constraints.size() == before) {
    lexer_.fail_here("the number of a constraint is expected");
  }
}

bool FeReader::own_attribute(FeElement element, FeMarks& marks) {
  const int index = attribute_index(element, lexer_.peek().text);
  if (index < 0) {
    return false;
  }
  lexer_.take();
  on_line();
  marks.attributes.emplace_back(index, constant());
  return true;
}

bool FeReader::own_quantity(FeElement element, FeMarks& marks) {
  const auto found = quantity_.find(lexer_.peek().text);
  if (element != FeElement::Facets || found == quantity_.end()) {
    return false;
  }
  lexer_.take();
  if (on_line() && lexer_.peek().is("-")) {
    lexer_.fail_here("quantities on the back of a face are not supported");
  }
  marks.quantities.push_back(found->second);
  return true;
}

void FeReader::unknown_mark(const char* element) {
  lexer_.fail_here(fmt::format(
      "this attribute of a {} is not known or not supported", element));
}

void FeReader::skip_separators() {
  while (lexer_.peek().is(",") || lexer_.peek().is(":") ||
         lexer_.peek().is(";")) {
    lexer_.take();
  }
}

}  // namespace meniscus::datafile
