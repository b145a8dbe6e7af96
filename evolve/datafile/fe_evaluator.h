/// Internal to fe_script: values of formulas in commands, which may speak of
/// elements and their attributes.
#pragma once

#include <string>
#include <vector>

#include "evolve/datafile/fe_commands.h"
#include "evolve/datafile/fe_session.h"

namespace meniscus::datafile {

/// All functions throw InvalidInput "file:line:column: what".
class FeEvaluator {
 public:
  FeEvaluator(const FeSession& session, std::string file)
      : session_(session), file_(std::move(file)) {}

  double value(const FeExpression& expression);
  /// "vertex", "edges", ... of a path that names all elements of a kind.
  FeKind kind(const FeElements& elements) const;
  /// Those that the elements' condition holds for.
  std::vector<FeElementRef> chosen(const FeElements& elements);
  /// The element whose attribute `target` is, as in body[1].target.
  FeElementRef owner(const FeExpression& target);

  /// An element at hand while it lives: its attributes are plain names.
  class Scope {
   public:
    Scope(FeEvaluator& evaluator, std::string variable, FeElementRef element)
        : evaluator_(evaluator) {
      evaluator_.scopes_.push_back({std::move(variable), element});
    }
    ~Scope() { evaluator_.scopes_.pop_back(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    FeEvaluator& evaluator_;
  };

  [[noreturn]] void fail(const FePlace& place, const std::string& what) const;

 private:
  struct AtHand {
    std::string variable;
    FeElementRef element;
  };

  double at(const FeExpression& expression, int node);
  double name(const FeNode& node) const;
  double member(const FeExpression& expression, const FeNode& node);
  double aggregate(const FeExpression& expression, const FeNode& node);
  FeElementRef element(const FeExpression& expression, int node);
  FeKind kind(const FeNode& node) const;

  const FeSession& session_;
  std::string file_;
  std::vector<AtHand> scopes_;
};

}  // namespace meniscus::datafile
