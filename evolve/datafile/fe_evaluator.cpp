#include "evolve/datafile/fe_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::datafile {

void FeEvaluator::fail(const FePlace& place, const std::string& what) const {
  throw InvalidInput(
      fmt::format("{}:{}:{}: {}", file_, place.line, place.column, what));
}

double FeEvaluator::value(const FeExpression& expression) {
  if (expression.is_number()) {
    return expression.number;
  }
  const double result =
      at(expression, static_cast<int>(expression.nodes.size()) - 1);
  if (!std::isfinite(result)) {
    fail(expression.place, fmt::format("this is {}", result));
  }
  return result;
}

double FeEvaluator::at(const FeExpression& expression, int index) {
  const FeNode& node = expression.nodes[index];
  const auto child = [&](int k) {
    return node.child[k] < 0 ? 0.0 : at(expression, node.child[k]);
  };
  switch (node.op) {
    case FeOperator::Number:
      return node.number;
    case FeOperator::Name:
      return name(node);
    case FeOperator::Member:
      return member(expression, node);
    case FeOperator::Aggregate:
      return aggregate(expression, node);
    case FeOperator::Text:
      fail(node.place, "a number is expected, found a text");
    case FeOperator::Choose:
      return child(0) != 0.0 ? child(1) : child(2);
    case FeOperator::And:
      return child(0) != 0.0 && child(1) != 0.0 ? 1.0 : 0.0;
    case FeOperator::Or:
      return child(0) != 0.0 || child(1) != 0.0 ? 1.0 : 0.0;
    default:
      break;
  }
  const double a = child(0);
  const double b = child(1);
  return operation_value(node, a, b, child(2));
}

double FeEvaluator::name(const FeNode& node) const {
  for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
    if (scope->variable == node.name) {
      return *session_.attribute(scope->element, "id", 0);
    }
    if (const auto found = session_.attribute(scope->element, node.name, 0)) {
      return *found;
    }
  }
  if (const auto found = session_.value(node.name)) {
    return *found;
  }
  fail(node.place, fmt::format("'{}' has no value here", node.name));
}

double FeEvaluator::member(const FeExpression& expression, const FeNode& node) {
  const int owner = node.child[0];
  if (node.name == "on_constraint" || node.name == "on_boundary") {
    if (scopes_.empty()) {
      fail(node.place, node.name + " needs an element at hand");
    }
    const auto number = static_cast<int>(at(expression, node.child[1]));
    const auto found =
        session_.attribute(scopes_.back().element, node.name, number);
    if (!found) {
      fail(node.place, "such elements are on none: " + node.name);
    }
    return *found;
  }
  if (owner < 0) {
    return *session_.attribute(
        element(expression, static_cast<int>(&node - expression.nodes.data())),
        "id", 0);
  }
  const FeNode& whole = expression.nodes[owner];
  if (whole.op == FeOperator::Name) {
    if (const auto found = session_.quantity(whole.name, node.name)) {
      return *found;
    }
  }
  const auto found =
      node.child[1] < 0
          ? session_.attribute(element(expression, owner), node.name, 0)
          : std::nullopt;
  if (!found) {
    fail(node.place,
         fmt::format("the attribute '{}' is not known here", node.name));
  }
  return *found;
}

FeElementRef FeEvaluator::element(const FeExpression& expression, int index) {
  const FeNode& node = expression.nodes[index];
  if (node.op == FeOperator::Name) {
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
      if (scope->variable == node.name) {
        return scope->element;
      }
    }
    fail(node.place, fmt::format("'{}' is no element", node.name));
  }
  if (node.op != FeOperator::Member || node.child[0] >= 0 ||
      node.child[1] < 0) {
    fail(node.place, "elements of elements are not supported");
  }
  const FeKind of = kind(node);
  const double id = at(expression, node.child[1]);
  constexpr double kMost = std::numeric_limits<int>::max();
  const auto found = std::abs(id) < kMost
                         ? session_.element(of, static_cast<int>(id))
                         : std::nullopt;
  if (!found) {
    fail(node.place, fmt::format("there is no {}[{}]", node.name, id));
  }
  return *found;
}

FeKind FeEvaluator::kind(const FeNode& node) const {
  static const std::map<std::string, FeKind> kKinds = {
      {"vertex", FeKind::Vertices}, {"vertices", FeKind::Vertices},
      {"edge", FeKind::Edges},      {"edges", FeKind::Edges},
      {"facet", FeKind::Facets},    {"facets", FeKind::Facets},
      {"face", FeKind::Facets},     {"faces", FeKind::Facets},
      {"body", FeKind::Bodies},     {"bodies", FeKind::Bodies}};
  const auto found = kKinds.find(node.name);
  if (found == kKinds.end()) {
    fail(node.place,
         fmt::format("vertices, edges, facets or bodies are expected, "
                     "found '{}'",
                     node.name));
  }
  return found->second;
}

FeKind FeEvaluator::kind(const FeElements& elements) const {
  const FeNode& node = elements.path.nodes.back();
  if (elements.path.nodes.size() > 1) {
    fail(node.place, "elements of elements are not supported");
  }
  return kind(node);
}

std::vector<FeElementRef> FeEvaluator::chosen(const FeElements& elements) {
  const FeNode& last = elements.path.nodes.back();
  std::vector<FeElementRef> all;
  if (last.op == FeOperator::Member && last.child[0] < 0) {
    all.push_back(element(elements.path,
                          static_cast<int>(elements.path.nodes.size()) - 1));
  } else {
    const FeKind of = kind(elements);
    for (int k = 0; k < session_.count(of); ++k) {
      all.push_back({of, k});
    }
  }
  if (!elements.where.empty()) {
    std::erase_if(all, [&](const FeElementRef& one) {
      const Scope scope(*this, elements.variable, one);
      return value(elements.where.front()) == 0.0;
    });
  }
  return all;
}

FeElementRef FeEvaluator::owner(const FeExpression& target) {
  return element(target, target.nodes.back().child[0]);
}

double FeEvaluator::aggregate(const FeExpression& expression,
                              const FeNode& node) {
  const FeNode& elements = expression.nodes[node.child[0]];
  if (elements.op != FeOperator::Name) {
    fail(elements.place, "elements of elements are not supported");
  }
  const FeKind of = kind(elements);
  double sum = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  int count = 0;
  for (int k = 0; k < session_.count(of); ++k) {
    const Scope scope(*this, node.variable, {of, k});
    if (node.child[1] >= 0 && at(expression, node.child[1]) == 0.0) {
      continue;
    }
    const double one = node.child[2] < 0 ? 1.0 : at(expression, node.child[2]);
    sum += one;
    least = std::min(least, one);
    most = std::max(most, one);
    ++count;
  }
  return node.name == "count" ? count
         : node.name == "sum" ? sum
         : node.name == "avg" ? sum / count
         : node.name == "min" ? least
                              : most;
}

}  // namespace meniscus::datafile
