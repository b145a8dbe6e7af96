#include <fmt/format.h>

#include "evolve/datafile/fe_reader.h"

namespace meniscus::datafile {

namespace {

const std::map<std::string, FeMethod::Kind, std::less<>>& methods() {
  static const std::map<std::string, FeMethod::Kind, std::less<>> known = {
      {"facet_vector_integral", FeMethod::Kind::VectorIntegral},
      {"facet_scalar_integral", FeMethod::Kind::ScalarIntegral},
      {"facet_area", FeMethod::Kind::Area},
      {"facet_volume", FeMethod::Kind::Volume}};
  return known;
}

FeExpression one() {
  FeExpression expression;
  expression.number = 1.0;
  return expression;
}

}  // namespace

// quantity NAME energy|fixed = a|info_only [modulus a] method ...
void FeReader::quantity(const FePlace& place) {
  FeQuantity made;
  made.place = place;
  made.name = declared_name("a quantity");
  if (lexer_.peek().is(";")) {
    return;  // announced only, as in dumps
  }
  made.modulus = one();
  skip_separators();
  const FeToken role = lexer_.take();
  if (role.is_name("energy")) {
    made.role = FeQuantity::Role::Energy;
  } else if (role.is_name("fixed")) {
    made.role = FeQuantity::Role::Fixed;
    accept("=");
    made.target = constant();
  } else if (!role.is_name("info_only")) {
    lexer_.fail(role.place,
                fmt::format("quantity '{}': energy, fixed = value or info_only "
                            "is expected, found '{}'",
                            made.name, role.text));
  }
  for (skip_separators();; skip_separators()) {
    const FeToken& token = lexer_.peek();
    if (token.is_name("modulus")) {
      lexer_.take();
      made.modulus = constant();
    } else if (token.is_name("tolerance") ||
               token.is_name("lagrange_multiplier")) {
      lexer_.take();
      constant();
    } else if (token.is_name("method") || token.is_name("global_method")) {
      method_of(made, lexer_.take().text == "global_method");
    } else if (token.is_name("function") || token.is_name("volconst")) {
      lexer_.fail_here(fmt::format(
          "quantity '{}': sums of methods are supported only", made.name));
    } else {
      break;
    }
  }
  if (made.methods.empty()) {
    lexer_.fail_here(
        fmt::format("quantity '{}': 'method' is expected", made.name));
  }
  if (!quantity_.emplace(made.name, static_cast<int>(file_.quantities.size()))
           .second) {
    lexer_.fail(place,
                fmt::format("quantity '{}' is declared twice", made.name));
  }
  file_.quantities.push_back(std::move(made));
}

void FeReader::method_of(FeQuantity& quantity, bool global) {
  skip_separators();
  const FeToken& token = lexer_.peek();
  const auto named = methods_.find(token.text);
  if (token.kind == FeToken::Kind::Name && named != methods_.end()) {
    quantity.methods.push_back(named->second);
    lexer_.take();
  } else {
    quantity.methods.push_back(method(token.place));
  }
  FeMethod& made = quantity.methods.back();
  made.global = made.global || global;
}

// METHOD_INSTANCE name METHOD ...
void FeReader::method_instance(const FePlace& place) {
  const std::string name = declared_name("a method instance");
  if (lexer_.peek().is(";")) {
    return;
  }
  if (!lexer_.peek().is_name("method")) {
    lexer_.fail_here("'method' is expected");
  }
  lexer_.take();
  FeMethod made = method(place);
  made.name = name;
  if (!methods_.emplace(name, std::move(made)).second) {
    lexer_.fail(place,
                fmt::format("method instance '{}' is declared twice", name));
  }
}

FeMethod FeReader::method(const FePlace& place) {
  skip_separators();
  const FeToken kind = lexer_.take();
  const auto found = methods().find(kind.text);
  if (kind.kind != FeToken::Kind::Name || found == methods().end()) {
    lexer_.fail(kind.place,
                fmt::format("method '{}' is not supported; there are "
                            "facet_vector_integral, facet_scalar_integral, "
                            "facet_area and facet_volume",
                            kind.text));
  }
  FeMethod made;
  made.place = place;
  made.kind = found->second;
  made.modulus = one();
  for (skip_separators();; skip_separators()) {
    if (lexer_.peek().is_name("global")) {
      lexer_.take();
      made.global = true;
    } else if (lexer_.peek().is_name("modulus")) {
      lexer_.take();
      skip_separators();
      made.modulus = constant();
    } else {
      break;
    }
  }
  integrand(made);
  return made;
}

void FeReader::integrand(FeMethod& method) {
  if (method.kind == FeMethod::Kind::VectorIntegral) {
    if (!lexer_.peek().is_name("vector_integrand")) {
      lexer_.fail_here("'vector_integrand:' is expected");
    }
    lexer_.take();
    method.vector = field("q", Sees::Place);
  } else if (method.kind == FeMethod::Kind::ScalarIntegral) {
    if (!lexer_.peek().is_name("scalar_integrand")) {
      lexer_.fail_here("'scalar_integrand:' is expected");
    }
    lexer_.take();
    skip_separators();
    method.scalar = formula(Sees::Place);
  }
}

}  // namespace meniscus::datafile
