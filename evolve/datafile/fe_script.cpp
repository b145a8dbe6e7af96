#include "evolve/datafile/fe_script.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/nearest_name.h"
#include "evolve/datafile/fe_commands.h"
#include "evolve/datafile/fe_evaluator.h"
#include "evolve/datafile/fe_format.h"
#include "evolve/datafile/fe_session.h"

namespace meniscus::datafile {

namespace {

constexpr int kDeepestCalls = 60;
constexpr std::size_t kMostOutput = 1'000'000;
constexpr double kMostRepeats = 1e9;
constexpr double kMostFacets = 8e6;

using Kind = FeStatement::Kind;
enum class Flow { Next, Break, Continue };

// Toggles that change how steps are made or shown, not what is at rest.
bool is_harmless(const std::string& toggle) {
  static const std::set<std::string> kHarmless = {
      "autorecalc",         "autodisplay",         "quiet",
      "hessian_normal",     "hessian_normal_perp", "hessian_special_normal",
      "hessian_diff",       "hessian_quiet",       "check_increase",
      "normal_motion",      "gv_binary",           "estimate",
      "area_normalization", "approx_curv",         "deturck",
      "linear_metric",      "metric_conversion",   "post_project"};
  return kHarmless.count(toggle) != 0;
}

bool is_color(const std::string& attribute) {
  static const std::set<std::string> kColors = {
      "color", "frontcolor", "backcolor", "opacity", "nodisplay"};
  return kColors.count(attribute) != 0;
}

class Runner {
 public:
  Runner(const FeFile& file, FeSession& session, const FeScriptOptions& options)
      : name_(file.name),
        statements_(
            parse_commands(file.commands, file.name, file.commands_line)),
        session_(session),
        evaluator_(session, file.name),
        options_(options) {}

  void run() {
    run(statements_);
    if (!options_.macro) {
      return;
    }
    const auto found = macros_.find(*options_.macro);
    if (found == macros_.end()) {
      std::vector<std::string> known;
      for (const auto& [macro, body] : macros_) {
        known.push_back(macro);
      }
      throw InvalidInput(fmt::format(
          "{}: there is no macro '{}'; it has: {}", name_, *options_.macro,
          known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
    }
    run(*found->second);
  }

  std::string output;

 private:
  void count_step(const FeStatement& statement) {
    if (++steps_ > options_.most_steps) {
      evaluator_.fail(statement.place,
                      fmt::format("the macro does not end within {} commands",
                                  options_.most_steps));
    }
    work_ += static_cast<double>(session_.complex().mesh.facets.size());
    if (work_ > options_.most_work) {
      evaluator_.fail(
          statement.place,
          fmt::format("the commands take more than {:.2g} facets times steps",
                      options_.most_work));
    }
    if (options_.monitor != nullptr) {
      throw_if_stopped(*options_.monitor, "film");
    }
  }

  Flow run(const std::vector<FeStatement>& statements) {
    for (const FeStatement& statement : statements) {
      if (const Flow flow = run(statement); flow != Flow::Next) {
        return flow;
      }
    }
    return Flow::Next;
  }

  Flow run(const FeStatement& statement) {
    count_step(statement);
    switch (statement.kind) {
      case Kind::Block:
        return statement.values.empty()
                   ? run(statement.body)
                   : repeated(statement, [&] { return run(statement.body); });
      case Kind::Define:
        macros_[statement.name] = &statement.body;
        return Flow::Next;
      case Kind::If:
        return branch(statement);
      case Kind::While:
      case Kind::DoWhile:
      case Kind::For:
        loop(statement);
        return Flow::Next;
      case Kind::Foreach:
        foreach (statement)
          ;
        return Flow::Next;
      case Kind::Call:
        return repeated(statement, [&] { return call(statement); });
      case Kind::Break:
        return Flow::Break;
      case Kind::Continue:
        return Flow::Continue;
      default:
        act(statement);
        return Flow::Next;
    }
  }

  void act(const FeStatement& statement) {
    switch (statement.kind) {
      case Kind::Assign:
        assign(statement);
        break;
      case Kind::Letter:
        letter(statement);
        break;
      case Kind::Word:
        word(statement);
        break;
      case Kind::Toggle:
        toggle(statement);
        break;
      case Kind::Print:
      case Kind::Printf:
        print(statement);
        break;
      case Kind::Set:
      case Kind::Unset:
        set(statement);
        break;
      case Kind::Elements:
        elements(statement);
        break;
      default:
        evaluator_.fail(statement.place,
                        fmt::format("'{}' is not supported", statement.name));
    }
    if (session_.complex().mesh.facets.empty()) {
      evaluator_.fail(statement.place, "no facet of the film is left");
    }
  }

  template <class Work>
  Flow repeated(const FeStatement& statement, const Work& work) {
    const double times =
        statement.values.empty() ? 1.0 : number(statement, kMostRepeats);
    for (double k = 0.0; k < times; k += 1.0) {
      count_step(statement);
      if (work() == Flow::Break) {
        break;
      }
    }
    return Flow::Next;
  }

  double number(const FeStatement& statement, double most) {
    const double result = evaluator_.value(statement.values.front());
    if (std::abs(result) > most) {
      evaluator_.fail(statement.values.front().place,
                      fmt::format("{} is too much", result));
    }
    return result;
  }

  Flow call(const FeStatement& statement) {
    const auto found = macros_.find(statement.name);
    if (found == macros_.end()) {
      evaluator_.fail(
          statement.place,
          fmt::format("'{}' is not defined before it is used", statement.name));
    }
    if (++depth_ > kDeepestCalls) {
      evaluator_.fail(statement.place, "macros call each other without end");
    }
    run(*found->second);
    --depth_;
    return Flow::Next;
  }

  bool holds(const FeExpression& condition) {
    return evaluator_.value(condition) != 0.0;
  }

  Flow branch(const FeStatement& statement) {
    if (holds(statement.values.front())) {
      return run(statement.body.front());
    }
    return statement.body.size() > 1 ? run(statement.body[1]) : Flow::Next;
  }

  void loop(const FeStatement& statement) {
    const FeExpression& condition = statement.values.front();
    const bool is_for = statement.kind == Kind::For;
    if (is_for) {
      run(statement.body.front());
    }
    bool first = statement.kind == Kind::DoWhile;
    while (first || holds(condition)) {
      first = false;
      count_step(statement);
      if (run(statement.body.back()) == Flow::Break) {
        break;
      }
      if (is_for) {
        run(statement.body[1]);
      }
    }
  }

  void foreach (const FeStatement& statement) {
    for (const FeElementRef& element : evaluator_.chosen(statement.elements)) {
      const FeEvaluator::Scope scope(evaluator_, statement.elements.variable,
                                     element);
      if (run(statement.body.front()) == Flow::Break) {
        break;
      }
    }
  }

  void assign(const FeStatement& statement) {
    const FeExpression& target = statement.values.front();
    const FeNode& last = target.nodes.back();
    double result = evaluator_.value(statement.values.back());
    if (statement.name != ":=") {
      const double left = evaluator_.value(target);
      result = statement.name == "+="   ? left + result
               : statement.name == "-=" ? left - result
               : statement.name == "*=" ? left * result
                                        : left / result;
      if (!std::isfinite(result)) {
        evaluator_.fail(last.place,
                        fmt::format("'{}' becomes {}", last.name, result));
      }
    }
    if (last.op == FeOperator::Name) {
      session_.assign(last.name, result);
    } else if (last.child[0] < 0 || last.child[1] >= 0 ||
               !session_.set_attribute(evaluator_.owner(target), last.name,
                                       result)) {
      evaluator_.fail(last.place,
                      fmt::format("'{}' cannot be set here", last.name));
    }
  }

  void letter(const FeStatement& statement) {
    const std::string& name = statement.name;
    const auto repeat = [&](const auto& work) {
      repeated(statement, [&] {
        work();
        return Flow::Next;
      });
    };
    if (name == "g") {
      const double steps =
          statement.values.empty() ? 1.0 : number(statement, kMostRepeats);
      session_.descend_steps(static_cast<int>(steps));
    } else if (name == "r") {
      repeat([&] { refine(statement); });
    } else if (name == "u") {
      repeat([&] { session_.flip(); });
    } else if (name == "V") {
      repeat([&] { session_.average(); });
    } else if (name == "U") {
      session_.conjugate(!session_.is_conjugate());
    } else if (name == "o") {
      repeat([&] { session_.pop_all(); });
    } else if (name == "t") {
      session_.remove_tiny(needed(statement));
    } else if (name == "G") {
      session_.gravity(needed(statement));
    } else if (name != "s" && name != "q") {  // views
      evaluator_.fail(statement.place,
                      fmt::format("the command '{}' is not supported", name));
    }
  }

  void refine(const FeStatement& statement) {
    if (4.0 * session_.count(FeKind::Facets) > kMostFacets) {
      evaluator_.fail(statement.place,
                      fmt::format("more than {} facets", kMostFacets));
    }
    session_.refine_all();
  }

  double needed(const FeStatement& statement) {
    if (statement.values.empty()) {
      evaluator_.fail(
          statement.place,
          fmt::format("a number is expected behind '{}'", statement.name));
    }
    return evaluator_.value(statement.values.front());
  }

  void word(const FeStatement& statement) {
    const std::string& name = statement.name;
    const auto repeat = [&](const auto& work) {
      repeated(statement, [&] {
        work();
        return Flow::Next;
      });
    };
    if (name == "hessian" || name == "hessian_seek") {
      repeat([&] { session_.newton_step(); });
    } else if (name == "recalc") {
      session_.recalculate_all();
    } else if (name == "equiangulate") {
      repeat([&] { session_.flip(); });
    } else if (name == "vertex_average") {
      repeat([&] { session_.average(); });
    } else if (name == "edgeweed") {
      session_.remove_tiny(needed(statement));
    } else if (name != "linear" && name != "convert_to_quantities") {
      evaluator_.fail(statement.place,
                      fmt::format("'{}' is not supported", name));
    }
  }

  void toggle(const FeStatement& statement) {
    const bool on =
        statement.values.empty() || statement.values.front().number != 0.0;
    if (statement.name == "conj_grad") {
      session_.conjugate(on);
    } else if (on && !is_harmless(statement.name)) {
      evaluator_.fail(statement.place,
                      fmt::format("'{}' is not supported", statement.name));
    }
  }

  void print(const FeStatement& statement) {
    if (statement.kind == Kind::Print) {
      output += fmt::format("{}\n", evaluator_.value(statement.values.front()));
    } else {
      std::vector<double> values;
      for (std::size_t k = 1; k < statement.values.size(); ++k) {
        values.push_back(evaluator_.value(statement.values[k]));
      }
      const auto text =
          fe_formatted(statement.values.front().nodes.back().name, values);
      if (!text) {
        evaluator_.fail(statement.place,
                        "this format does not fit its numbers; %d %f %e %g "
                        "with widths are known");
      }
      output += *text;
    }
    if (output.size() > kMostOutput) {
      evaluator_.fail(statement.place, "the macro prints without end");
    }
  }

  void set(const FeStatement& statement) {
    const std::string& name = statement.name;
    if (is_color(name)) {
      return;
    }
    const bool on = statement.kind == Kind::Set;
    for (const FeElementRef& element : evaluator_.chosen(statement.elements)) {
      const FeEvaluator::Scope scope(evaluator_, statement.elements.variable,
                                     element);
      const bool has_value = !statement.values.empty();
      bool done = false;
      if (name == "fixed") {
        done = on ? session_.fix(element) : session_.unfix(element);
      } else if (on && has_value) {
        done = session_.set_attribute(
            element, name, evaluator_.value(statement.values.front()));
      } else if (has_value) {
        done = session_.release(
            element, name, static_cast<int>(number(statement, kMostRepeats)));
      }
      if (!done) {
        evaluator_.fail(
            statement.place,
            fmt::format("'{}' cannot be {} here", name, on ? "set" : "unset"));
      }
    }
  }

  void elements(const FeStatement& statement) {
    const std::string& name = statement.name;
    const std::vector<FeElementRef> all = evaluator_.chosen(statement.elements);
    if (name == "refine" && (all.empty() || all[0].kind == FeKind::Edges)) {
      std::vector<bool> chosen(session_.count(FeKind::Edges));
      for (const FeElementRef& edge : all) {
        chosen[edge.index] = true;
      }
      session_.refine_edges([&](int edge) { return chosen[edge]; });
      return;
    }
    for (const FeElementRef& element : all) {
      const bool done = name == "fix"     ? session_.fix(element)
                        : name == "unfix" ? session_.unfix(element)
                                          : false;
      if (!done) {
        evaluator_.fail(statement.place,
                        fmt::format("'{}' is not supported here", name));
      }
    }
  }

  std::string name_;
  std::vector<FeStatement> statements_;
  FeSession& session_;
  FeEvaluator evaluator_;
  const FeScriptOptions& options_;
  std::map<std::string, const std::vector<FeStatement>*> macros_;
  long steps_ = 0;
  double work_ = 0.0;  // facets x steps
  int depth_ = 0;
};

}  // namespace

FeScriptResult run_fe_script(const FeFile& file,
                             const std::map<std::string, double>& parameters,
                             const FeScriptOptions& options) {
  FeSession session(file, parameters, options.monitor);
  Runner runner(file, session, options);
  runner.run();
  return {session.complex(), std::move(runner.output), session.iterations()};
}

}  // namespace meniscus::datafile
