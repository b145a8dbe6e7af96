#include "core/math/expression.h"

#include <clocale>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/math/bound_text.h"
#include "tests/support/not_here.h"

namespace meniscus::expression_test {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kNames = {"a", "b", "support_x"};

double value(const std::string& text, std::vector<double> values = {2, 3, 0}) {
  return Expression::parse(text, kNames).evaluate(values);
}

/// Message and column of the error that `text` makes when read or evaluated.
std::string error_of(const std::string& text,
                     std::vector<double> values = {2, 3, 0}) {
  try {
    value(text, std::move(values));
  } catch (const ExpressionError& error) {
    return std::to_string(error.column()) + ": " + error.what();
  }
  return "no error";
}

TEST(Expression, KeepsThePrecedenceOfArithmetic) {
  EXPECT_EQ(value("1 + 2 * 3"), 7.0);
  EXPECT_EQ(value("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(value("8 - 3 - 2"), 3.0);
  EXPECT_EQ(value("16 / 4 / 2"), 2.0);
  EXPECT_EQ(value("2 ^ 3 ^ 2"), 512.0);
  EXPECT_EQ(value("-2 ^ 2"), -4.0);
  EXPECT_EQ(value("2 ^ -1"), 0.5);
  EXPECT_EQ(value("--a + -+-b"), 5.0);
  EXPECT_EQ(value("2 * -3"), -6.0);
  EXPECT_EQ(value("1e3 + .5 + 2.5e-1"), 1000.75);
  EXPECT_EQ(value("1 < 2"), 1.0);
  EXPECT_EQ(value("a >= b"), 0.0);
  EXPECT_EQ(value("a + 1 == b"), 1.0);
  EXPECT_EQ(value("a != 2"), 0.0);
}

TEST(Expression, KnowsTheNameThatIsAllOfIt) {
  const std::vector<std::string> names = {"a", "b"};
  EXPECT_EQ(Expression::parse("b", names).bare_name(), 1);
  EXPECT_EQ(Expression::parse("(a)", names).bare_name(), 0);
  for (const char* more : {"-b", "b + 0", "2", "sin(a)"}) {
    EXPECT_EQ(Expression::parse(more, names).bare_name(), -1) << more;
  }
}

TEST(Expression, PowersOfZeroHaveDerivativesWhereTheyAre) {
  const Expression f = Expression::parse("a^b", kNames);
  const auto at = [&](double b) {
    const std::vector<Dual> values = {Dual::variable(0.0, 0, 2),
                                      Dual::variable(b, 1, 2), Dual(0.0)};
    return f.evaluate(values);
  };
  for (const double b : {2.0, 2.5, 3.0}) {
    const Dual zero = at(b);
    EXPECT_EQ(zero.value, 0.0);
    EXPECT_EQ(zero.gradient.norm(), 0.0);
    EXPECT_EQ(zero.hessian(0, 0), b == 2.0 ? 2.0 : 0.0);
    EXPECT_EQ(zero.hessian(0, 1), 0.0);
    EXPECT_EQ(zero.hessian(1, 1), 0.0);
  }
  EXPECT_THROW(at(1.5), ExpressionError);  // bends without end
}

TEST(Expression, KnowsItsFunctionsAndConstants) {
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(value("sin(30 * deg)"), 0.5, kRounding);
  EXPECT_NEAR(value("cos(pi) + log(e)"), 0.0, kRounding);
  EXPECT_NEAR(value("log10(1000)"), 3.0, 4 * kRounding);
  EXPECT_EQ(value("min(a, b) + 10 * max(a, b)"), 32.0);
  EXPECT_EQ(value("sqr(b) + abs(-a) + sqrt(16) + pow(a, b)"), 23.0);
  EXPECT_EQ(value("atan2(1, -1)"), std::atan2(1.0, -1.0));
  EXPECT_EQ(value("tanh(a) - sinh(a) / cosh(a) < 1e-15"), 1.0);
}

TEST(Expression, BracketsSwitchAndRamp) {
  const auto bracket = [](double s, double n, double w) {
    return value(fmt::format("macaulay({}, {}, {})", s, n, w));
  };
  EXPECT_EQ(bracket(-0.1, 0, 0), 0.0);
  EXPECT_EQ(bracket(0, 0, 0), 1.0);
  EXPECT_EQ(bracket(-3, 1.5, 0), 0.0);
  EXPECT_EQ(bracket(2, 1, 0), 2.0);
  EXPECT_EQ(bracket(2, 3, 0), 8.0);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> draw(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const double s = std::pow(10.0, 4.0 * draw(random) - 3.0);
    const double w = std::pow(10.0, 3.0 * draw(random) - 3.0);
    const double n = 3.0 * draw(random);
    const double root = std::sqrt(s * s + w * w);
    EXPECT_NEAR(bracket(s, 0, w), (1 + s / root) / 2, 1e-15);
    EXPECT_NEAR(bracket(s, n, w), std::pow((s + root) / 2, n),
                1e-14 * std::pow(root, n));
    // To both sides of 0: <s> - <-s> = s and <s> <-s> = w^2 / 4, which the
    // plain formula loses for s far below 0; switches add up to 1.
    EXPECT_NEAR(bracket(s, 1, w) - bracket(-s, 1, w), s, 1e-15 * root);
    EXPECT_NEAR(bracket(s, 1, w) * bracket(-s, 1, w), w * w / 4, 1e-15 * w * w);
    EXPECT_NEAR(bracket(s, 0, w) + bracket(-s, 0, w), 1.0, 1e-15);
  }
  EXPECT_THROW(bracket(1, -1, 2), ExpressionError);
}

TEST(Expression, EvaluatesOnlyTheBranchThatHolds) {
  const std::string guarded = "if(support_x == 0, 1, sin(support_x)/support_x)";
  EXPECT_EQ(value(guarded, {0, 0, 0}), 1.0);
  EXPECT_EQ(value(guarded, {0, 0, 0.5}), std::sin(0.5) / 0.5);
  EXPECT_EQ(value("if(a < b, if(b < a, 1, 2), 3) + 10"), 12.0);
  EXPECT_EQ(value("if(a > b, 1, if(1, 4, 1/0)) * 2"), 8.0);
}

TEST(Expression, ListsTheNamesThatItUses) {
  EXPECT_THAT(Expression::parse("support_x + a * a", kNames).names_used(),
              testing::ElementsAre(0, 2));
  EXPECT_TRUE(Expression::parse("2 * pi", kNames).is_constant());
  EXPECT_TRUE(Expression(4.0).is_constant());
  EXPECT_EQ(Expression().evaluate(std::span<const double>{}), 0.0);
}

TEST(Expression, NamesWhatIsWrongAndWhere) {
  EXPECT_EQ(error_of("1 + suport_x"),
            "5: unknown name 'suport_x' (did you mean 'support_x'?) in '1 + "
            "suport_x'");
  EXPECT_THAT(error_of("qqqq"), HasSubstr("unknown name 'qqqq' in"));
  EXPECT_THAT(error_of("sine(a)"), HasSubstr("did you mean 'sin'?"));
  EXPECT_THAT(error_of("(a + b"), HasSubstr("7: ')' is missing before 'end'"));
  EXPECT_THAT(error_of("a + b)"), HasSubstr("6: ')' without its '('"));
  EXPECT_THAT(error_of("a b"), HasSubstr("3: unexpected 'b'"));
  EXPECT_THAT(error_of("59.3mm"),
              HasSubstr("5: unexpected 'm' (write '59.3 mm' for a unit, "
                        "'59.3*mm' for a product)"));
  EXPECT_THAT(error_of("1,5"), HasSubstr("2: unexpected ','"));
  EXPECT_THAT(error_of(""), HasSubstr("a value is missing at the end"));
  EXPECT_THAT(error_of("a +"), HasSubstr("a value is missing at the end"));
  EXPECT_THAT(error_of("2 ** 3"), HasSubstr("4: a value is missing before"));
  EXPECT_THAT(error_of("sin()"), HasSubstr("a value is missing before ')'"));
  EXPECT_THAT(error_of("sin(1, 2)"), HasSubstr("sin takes 1 argument "));
  EXPECT_THAT(error_of("macaulay(1, 2)"),
              HasSubstr("macaulay takes 3 arguments"));
  EXPECT_THAT(error_of("atan2(1)"), HasSubstr("atan2 takes 2 arguments"));
  EXPECT_THAT(error_of("if(1, 2)"), HasSubstr("if takes 3 arguments"));
  EXPECT_THAT(error_of("if(1, 2, 3, 4)"), HasSubstr("if takes 3 arguments"));
  EXPECT_THAT(error_of("1e999"), HasSubstr("too large or too small"));
  EXPECT_THAT(error_of("a \xC3\xA4"), HasSubstr("unexpected '\xC3\xA4'"));
  EXPECT_THAT(error_of("nan"), HasSubstr("unknown name 'nan'"));
}

/// w, the elements of t [2 x 3] and of u [4], n; the value of an element has
/// its indices as digits.
const std::vector<std::string> kVectors = {
    "w",      "t[1,1]", "t[1,2]", "t[1,3]", "t[2,1]", "t[2,2]",
    "t[2,3]", "u[1]",   "u[2]",   "u[3]",   "u[4]",   "n"};
const std::vector<double> kElements = {0.5, 11, 12, 13, 21, 22,
                                       23,  1,  2,  3,  4,  2};

double element(const std::string& text) {
  std::vector<std::optional<double>> constants(kVectors.size());
  constants.back() = kElements.back();
  return Expression::parse(text, kVectors, constants).evaluate(kElements);
}

std::string element_error(const std::string& text) {
  try {
    element(text);
  } catch (const ExpressionError& error) {
    return std::to_string(error.column()) + ": " + error.what();
  }
  return "no error";
}

TEST(Expression, FindsTheElementsOfVectors) {
  EXPECT_EQ(element("t[2,3]"), 23.0);
  EXPECT_EQ(element("t [ 1 + 1 , (3) ]+u[4]"), 27.0);
  EXPECT_EQ(element("t[n, 7 - 2 * n] / u[n^n]"), 23.0 / 4.0);
  EXPECT_EQ(element("t[if(1 < 2, 2, 5), max(1, 2)] - u[1] * w"), 21.5);
  EXPECT_EQ(element("-u[3] ^ 2"), -9.0);
  const Expression f = Expression::parse("2 * t[ 2, 1+1 ] + w", kVectors);
  EXPECT_EQ(f.text(), "2 * t[2,2] + w");
  EXPECT_THAT(f.names_used(), testing::ElementsAre(0, 5));
  EXPECT_EQ(Expression::parse(f.text(), kVectors).evaluate(kElements), 44.5);
  EXPECT_EQ(element_name("t", std::vector<int>{2, 3}), "t[2,3]");
  EXPECT_EQ(shape_text(std::vector<int>{8, 12, 3}), "8 x 12 x 3");
}

TEST(Expression, TellsWhichIndexIsWrongAndTheShape) {
  EXPECT_EQ(element_error("1 + t[3,1]"),
            "5: t[3,1] is not there: 't' is 2 x 3, counted from 1, in "
            "'1 + t[3,1]'");
  EXPECT_THAT(element_error("u[0]"), HasSubstr("'u' is 4, counted from 1"));
  EXPECT_THAT(element_error("u[-1]"), HasSubstr("u[-1] is not there"));
  EXPECT_THAT(element_error("u[1e300]"), HasSubstr("u[1e+300] is not there"));
  EXPECT_THAT(element_error("t[2]"),
              HasSubstr("1: t[2] has 1 of 2 indices: 't' is 2 x 3, written "
                        "t[i, j]"));
  EXPECT_THAT(element_error("u[1, 2]"), HasSubstr("2 of 1 indices"));
  EXPECT_THAT(element_error("t[]"),
              HasSubstr("3: an index is missing: 't' is 2 x 3"));
  EXPECT_THAT(element_error("t[1,]"), HasSubstr("an index is missing"));
  EXPECT_THAT(element_error("t[,1]"), HasSubstr("an index is missing"));
  EXPECT_THAT(element_error("u[1.5]"),
              HasSubstr("3: the index 1.5 of 'u' is not whole: 'u' is 4"));
  EXPECT_THAT(element_error("u[1 + w]"),
              HasSubstr("depends on 'w', which moves or has no value: 'u' is "
                        "4"));
  EXPECT_THAT(element_error("u[t[1,1]]"), HasSubstr("depends on 't[1,1]'"));
  EXPECT_THAT(element_error("u[1/0]"), HasSubstr("division of 1 by zero"));
  EXPECT_THAT(element_error("u[1"), HasSubstr("']' is missing before 'end'"));
  EXPECT_THAT(element_error("u[1) + 2"), HasSubstr("']' is missing before ')"));
  EXPECT_THAT(element_error("2 * t"),
              HasSubstr("5: 't' has 2 x 3 elements: write one of them, "
                        "t[i, j]"));
  EXPECT_THAT(element_error("w[1]"), HasSubstr("2: unexpected '['"));
  EXPECT_THAT(element_error("tt[1, 1]"), HasSubstr("unknown name 'tt'"));
  EXPECT_THAT(element_error("u(1)"), HasSubstr("unknown function 'u'"));
}

TEST(Expression, BindsElementsInItsText) {
  const std::vector<std::string> names = {"t", "t[1,2]", "a"};
  const std::vector<double> values = {7, 0.25, 3};
  EXPECT_EQ(with_values("t[1,2] * a - x", names, values), "(0.25) * (3) - x");
  EXPECT_EQ(with_values("u[a, a] + t[", names, values), "u[(3), (3)] + (7)[");
  const Expression f = Expression::parse("u[3] * w + t[2, 1]", kVectors);
  const std::string bound = with_values(f.text(), kVectors, kElements);
  EXPECT_EQ(Expression::parse(bound, {}).evaluate(std::span<const double>{}),
            f.evaluate(kElements));
}

TEST(Expression, RefusesResultsThatAreNotFinite) {
  EXPECT_EQ(error_of("1/support_x"),
            "2: division of 1 by zero in '1/support_x'");
  EXPECT_THAT(error_of("sqrt(-a)"), HasSubstr("sqrt(-2) is not a finite"));
  EXPECT_THAT(error_of("1e200 * 1e200"),
              HasSubstr("1e+200 * 1e+200 is not a finite"));
  EXPECT_THAT(error_of("log(support_x)"), HasSubstr("log(0) is not a finite"));
  EXPECT_THAT(
      [] {
        try {
          Expression::parse("1 + t[1,2] * 2", {"t[1,1]", "t[1,2]"})
              .evaluate(std::vector<double>{1, std::nan("")});
        } catch (const ExpressionError& error) {
          return std::string(error.what());
        }
        return std::string();
      }(),
      HasSubstr("'t[1,2]' is nan, not a finite number"));
  EXPECT_THAT(error_of("0 * support_x", {0, 0, std::nan("")}),
              HasSubstr("5: 'support_x' is nan, not a finite number"));
}

TEST(Expression, BoundsDepthAndLength) {
  const std::string open(150, '(');
  const std::string close(150, ')');
  EXPECT_EQ(value(open + "1" + close), 1.0);
  EXPECT_THAT(error_of(std::string(1000000, '(')), HasSubstr("at most 10000"));
  EXPECT_THAT(error_of(std::string(9000, '(')), HasSubstr("more than 200"));
  std::string powers = "1";
  std::string calls;
  for (int k = 0; k < 3000; ++k) {
    powers += "^1";
    calls += "if(";
  }
  EXPECT_THAT(error_of(powers), HasSubstr("more than 200"));
  EXPECT_THAT(error_of(calls), HasSubstr("more than 200"));
  EXPECT_EQ(value(std::string(9000, '-') + "1"), 1.0);
}

TEST(Expression, ReadsAPointWhateverTheLocale) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) {
    MENISCUS_NOT_HERE("no locale with a decimal comma on this machine");
  }
  EXPECT_EQ(value("1.5 + 0.25"), 1.75);
  EXPECT_EQ(Expression(1.5).text(), "1.5");
  std::setlocale(LC_ALL, "C");
}

TEST(Expression, SurvivesRandomText) {
  const auto random_value = [](const std::string& text) {
    return Expression::parse(text, {"a", "b", "u[1]", "u[2]"})
        .evaluate(std::vector<double>{2, 3, 5, 7});
  };
  // No crash, no endless loop; either a finite number or a message.
  const std::vector<std::string> pieces = {"a",    "b",
                                           "1",    ".",
                                           "e",    "(",
                                           ")",    ",",
                                           "+",    "-",
                                           "*",    "/",
                                           "^",    "<",
                                           "=",    "if(",
                                           "min(", "sin(",
                                           " ",    "2e",
                                           "[",    "]",
                                           "u[",   "u[2]",
                                           "\xC3", std::string(1, '\0'),
                                           "!"};
  std::mt19937 generator(11);
  int good = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    const std::size_t length = generator() % 12;
    for (std::size_t k = 0; k < length; ++k) {
      text += pieces[generator() % pieces.size()];
    }
    try {
      EXPECT_TRUE(std::isfinite(random_value(text))) << text;
      ++good;
    } catch (const ExpressionError& error) {
      EXPECT_GE(error.column(), 1) << text;
      EXPECT_LE(error.column(), static_cast<int>(text.size()) + 1) << text;
    }
  }
  EXPECT_GT(good, 100);
}

/// First and second differences of `text` in a and b at `at`, compared with
/// the derivatives of its evaluation over duals.
void check_derivatives(const std::string& text, std::vector<double> at) {
  const Expression f = Expression::parse(text, kNames);
  const std::vector<Dual> duals = {Dual::variable(at[0], 0, 2),
                                   Dual::variable(at[1], 1, 2), Dual(at[2])};
  const Dual exact = f.evaluate(duals);
  EXPECT_EQ(exact.value, f.evaluate(at)) << text;
  if (exact.is_constant()) {
    return;
  }
  const double h = 1e-3;  // truncation h^4, rounding 1e-16 / h^2
  const auto gradient_at = [&](int j, double step) {
    std::vector<Dual> moved = duals;
    moved[static_cast<std::size_t>(j)].value += step;
    return f.evaluate(moved).gradient;
  };
  for (int j = 0; j < 2; ++j) {
    const auto value_at = [&](double step) {
      std::vector<double> moved = at;
      moved[static_cast<std::size_t>(j)] += step;
      return f.evaluate(moved);
    };
    const double slope = (8 * (value_at(h) - value_at(-h)) -
                          (value_at(2 * h) - value_at(-2 * h))) /
                         (12 * h);
    EXPECT_NEAR(exact.gradient[j], slope, 1e-8 * (1 + std::abs(slope)))
        << text << " by " << kNames[static_cast<std::size_t>(j)];
    const Eigen::VectorXd column =
        (8 * (gradient_at(j, h) - gradient_at(j, -h)) -
         (gradient_at(j, 2 * h) - gradient_at(j, -2 * h))) /
        (12 * h);
    EXPECT_LT((exact.hessian.col(j) - column).norm(),
              1e-8 * (1 + column.norm()))
        << text << " twice by " << kNames[static_cast<std::size_t>(j)];
  }
  EXPECT_LT((exact.hessian - exact.hessian.transpose()).norm(),
            1e-14 * (1 + exact.hessian.norm()))
      << text;
}

TEST(Dual, DerivativesAgreeWithDifferences) {
  for (const char* text : {"a + b",
                           "a - b",
                           "a * b",
                           "a / b",
                           "-a * a",
                           "a ^ b",
                           "a ^ 2",
                           "2 ^ a",
                           "pow(a, 2.5)",
                           "sqr(a * b)",
                           "sin(a * b)",
                           "cos(a - b)",
                           "tan(a / 4)",
                           "asin(a / 5)",
                           "acos(b / 5)",
                           "atan(a * b)",
                           "atan2(a, b)",
                           "sinh(a)",
                           "cosh(b)",
                           "tanh(a * b / 4)",
                           "exp(a - b)",
                           "log(a + b)",
                           "log10(a * b)",
                           "sqrt(a * a + b * b)",
                           "abs(a - b)",
                           "min(a, b) * a",
                           "max(a * a, b)",
                           "if(a < b, a * b, a / b)",
                           "macaulay(a - b, 0, 0.4)",
                           "macaulay(a - b, 1, 0.4)",
                           "macaulay(b - a, 1, support_x)",
                           "macaulay(a - b, b, support_x * a)",
                           "macaulay(a - 2 * b, 0, support_x)",
                           "macaulay(b - a, 3, 0)",
                           "exp(-sqr(a - b)) * sin(a) / (1 + b ^ 2)",
                           "support_x * a + 3"}) {
    check_derivatives(text, {1.3, 2.1, 0.7});
  }
}

TEST(Dual, IntegerPowersHaveDerivativesAtZero) {
  const std::vector<Dual> at = {Dual::variable(0.0, 0, 1), Dual(0.0),
                                Dual(0.0)};
  const Dual square = Expression::parse("a ^ 2", kNames).evaluate(at);
  EXPECT_EQ(square.gradient[0], 0.0);
  EXPECT_EQ(square.hessian(0, 0), 2.0);
  const Dual line = Expression::parse("a ^ 1", kNames).evaluate(at);
  EXPECT_EQ(line.gradient[0], 1.0);
  EXPECT_EQ(line.hessian(0, 0), 0.0);
}

TEST(Dual, RefusesValuesWithoutDerivative) {
  const std::vector<Dual> at = {Dual::variable(0.0, 0, 1), Dual(0.0),
                                Dual(0.0)};
  try {
    Expression::parse("1 + sqrt(a)", kNames).evaluate(at);
    FAIL() << "sqrt has no derivative at 0";
  } catch (const ExpressionError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sqrt(0) has no finite derivative"));
    EXPECT_EQ(error.column(), 5);
  }
}

TEST(ReservedNames, AreThoseThatExpressionsKnow) {
  for (const char* name : {"pi", "e", "deg", "sin", "if", "x", "y", "z"}) {
    EXPECT_TRUE(is_reserved_name(name)) << name;
  }
  EXPECT_FALSE(is_reserved_name("support_x"));
}

TEST(NearestName, FindsSlipsOfTheFinger) {
  const std::vector<std::string> known = {"volume", "pressure", "material"};
  EXPECT_EQ(nearest_name("volum", known), "volume");
  EXPECT_EQ(nearest_name("volmue", known), "volume");
  EXPECT_EQ(nearest_name("colour", known), "");
  EXPECT_EQ(nearest_name(std::string(1000000, 'v'), known), "");
  EXPECT_EQ(nearest_name("", known), "");
}

}  // namespace
}  // namespace meniscus::expression_test
