#include "core/math/expression.h"

#include <clocale>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(error_of("atan2(1)"), HasSubstr("atan2 takes 2 arguments"));
  EXPECT_THAT(error_of("if(1, 2)"), HasSubstr("if takes 3 arguments"));
  EXPECT_THAT(error_of("if(1, 2, 3, 4)"), HasSubstr("if takes 3 arguments"));
  EXPECT_THAT(error_of("1e999"), HasSubstr("too large or too small"));
  EXPECT_THAT(error_of("a \xC3\xA4"), HasSubstr("unexpected '\xC3\xA4'"));
  EXPECT_THAT(error_of("nan"), HasSubstr("unknown name 'nan'"));
}

TEST(Expression, RefusesResultsThatAreNotFinite) {
  EXPECT_EQ(error_of("1/support_x"),
            "2: division of 1 by zero in '1/support_x'");
  EXPECT_THAT(error_of("sqrt(-a)"), HasSubstr("sqrt(-2) is not a finite"));
  EXPECT_THAT(error_of("1e200 * 1e200"),
              HasSubstr("1e+200 * 1e+200 is not a finite"));
  EXPECT_THAT(error_of("log(support_x)"), HasSubstr("log(0) is not a finite"));
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
      EXPECT_TRUE(std::isfinite(value(text))) << text;
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
