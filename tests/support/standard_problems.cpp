#include "tests/support/standard_problems.h"

#include <cmath>

namespace meniscus::tests {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Row by row.
optimize::JacobianAnswer rows(Eigen::Index columns,
                              std::initializer_list<double> all) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(all.size()) / columns,
                         columns);
  Eigen::Index k = 0;
  for (const double number : all) {
    matrix(k / columns, k % columns) = number;
    ++k;
  }
  return {.jacobian = matrix, .failure = {}};
}

optimize::VectorAnswer values(std::initializer_list<double> all) {
  return {.values = vector_of(all), .failure = {}};
}

std::vector<optimize::Variable> box(const VectorX& start, double lower,
                                    double upper) {
  std::vector<optimize::Variable> variables;
  variables.reserve(static_cast<std::size_t>(start.size()));
  for (const double x : start) {
    variables.push_back(
        {"x" + std::to_string(variables.size() + 1), x, lower, upper});
  }
  return variables;
}

double sqr(double x) { return x * x; }

StandardProblem rosenbrock() {
  return {
      "rosenbrock",
      {box(vector_of({-1.2, 1.0}), -2.0, 2.0),
       "valley",
       {},
       [](const VectorX& x) {
         return values({100.0 * sqr(x[1] - sqr(x[0])) + sqr(1.0 - x[0])});
       },
       [](const VectorX& x) {
         const double d = x[1] - sqr(x[0]);
         return rows(2, {-400.0 * d * x[0] - 2.0 * (1.0 - x[0]), 200.0 * d});
       }},
      0.0,
      vector_of({1.0, 1.0}),
      false};
}

StandardProblem hs6() {
  return {"hs6",
          {box(vector_of({-1.2, 1.0}), -4.0, 4.0),
           "f",
           {{"h", 0.0, 0.0, {}}},
           [](const VectorX& x) {
             return values({sqr(1.0 - x[0]), 10.0 * (x[1] - sqr(x[0]))});
           },
           [](const VectorX& x) {
             return rows(2, {-2.0 * (1.0 - x[0]), 0.0, -20.0 * x[0], 10.0});
           }},
          0.0,
          vector_of({1.0, 1.0}),
          true};
}

StandardProblem hs24() {
  const double root = std::sqrt(3.0);
  return {"hs24",
          {box(vector_of({1.0, 0.5}), 0.0, 5.0),
           "f",
           {{"a", 0.0, kInf, {}}, {"b", 0.0, 6.0, {}}},
           [root](const VectorX& x) {
             return values(
                 {(sqr(x[0] - 3.0) - 9.0) * std::pow(x[1], 3) / (27.0 * root),
                  x[0] / root - x[1], x[0] + root * x[1]});
           },
           [root](const VectorX& x) {
             return rows(
                 2, {2.0 * (x[0] - 3.0) * std::pow(x[1], 3) / (27.0 * root),
                     (sqr(x[0] - 3.0) - 9.0) * sqr(x[1]) / (9.0 * root),
                     1.0 / root, -1.0, 1.0, root});
           }},
          -1.0,
          vector_of({3.0, root}),
          false};
}

StandardProblem hs35() {
  return {"hs35",
          {box(vector_of({0.5, 0.5, 0.5}), 0.0, 3.0),
           "f",
           {{"sum", -kInf, 3.0, {}}},
           [](const VectorX& x) {
             return values({9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2] +
                                2.0 * sqr(x[0]) + 2.0 * sqr(x[1]) + sqr(x[2]) +
                                2.0 * x[0] * x[1] + 2.0 * x[0] * x[2],
                            x[0] + x[1] + 2.0 * x[2]});
           },
           [](const VectorX& x) {
             return rows(3, {-8.0 + 4.0 * x[0] + 2.0 * x[1] + 2.0 * x[2],
                             -6.0 + 4.0 * x[1] + 2.0 * x[0],
                             -4.0 + 2.0 * x[2] + 2.0 * x[0], 1.0, 1.0, 2.0});
           }},
          1.0 / 9.0,
          vector_of({4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0}),
          false};
}

StandardProblem hs43() {
  return {
      "hs43",
      {box(vector_of({0.0, 0.0, 0.0, 0.0}), -5.0, 5.0),
       "f",
       {{"a", -kInf, 8.0, {}}, {"b", -kInf, 10.0, {}}, {"c", -kInf, 5.0, {}}},
       [](const VectorX& x) {
         const double squares = x.squaredNorm();
         return values({squares + sqr(x[2]) - 5.0 * x[0] - 5.0 * x[1] -
                            21.0 * x[2] + 7.0 * x[3],
                        squares + x[0] - x[1] + x[2] - x[3],
                        squares + sqr(x[1]) + sqr(x[3]) - x[0] - x[3],
                        2.0 * sqr(x[0]) + sqr(x[1]) + sqr(x[2]) + 2.0 * x[0] -
                            x[1] - x[3]});
       },
       [](const VectorX& x) {
         return rows(4, {2.0 * x[0] - 5.0, 2.0 * x[1] - 5.0, 4.0 * x[2] - 21.0,
                         2.0 * x[3] + 7.0, 2.0 * x[0] + 1.0, 2.0 * x[1] - 1.0,
                         2.0 * x[2] + 1.0, 2.0 * x[3] - 1.0, 2.0 * x[0] - 1.0,
                         4.0 * x[1], 2.0 * x[2], 4.0 * x[3] - 1.0,
                         4.0 * x[0] + 2.0, 2.0 * x[1] - 1.0, 2.0 * x[2], -1.0});
       }},
      -44.0,
      vector_of({0.0, 1.0, 2.0, -1.0}),
      false};
}

StandardProblem hs71() {
  return {"hs71",
          {box(vector_of({1.0, 5.0, 5.0, 1.0}), 1.0, 5.0),
           "f",
           {{"product", 25.0, kInf, {}}, {"squares", 40.0, 40.0, {}}},
           [](const VectorX& x) {
             return values({x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2],
                            x[0] * x[1] * x[2] * x[3], x.squaredNorm()});
           },
           [](const VectorX& x) {
             return rows(4, {x[3] * (2.0 * x[0] + x[1] + x[2]), x[0] * x[3],
                             x[0] * x[3] + 1.0, x[0] * (x[0] + x[1] + x[2]),
                             x[1] * x[2] * x[3], x[0] * x[2] * x[3],
                             x[0] * x[1] * x[3], x[0] * x[1] * x[2], 2.0 * x[0],
                             2.0 * x[1], 2.0 * x[2], 2.0 * x[3]});
           }},
          17.0140173,
          vector_of({1.0, 4.7429994, 3.8211503, 1.3794082}),
          true};
}

StandardProblem cantilever() {
  return {"cantilever",
          {box(VectorX::Constant(5, 5.0), 1.0, 10.0),
           "mass",
           {{"deflection", -kInf, 1.0, {}}},
           [](const VectorX& x) {
             double deflection = 0.0;
             const VectorX c = vector_of({61.0, 37.0, 19.0, 7.0, 1.0});
             for (Eigen::Index j = 0; j < 5; ++j) {
               deflection += c[j] / std::pow(x[j], 3);
             }
             return values({0.0624 * x.sum(), deflection});
           },
           [](const VectorX& x) {
             const VectorX c = vector_of({61.0, 37.0, 19.0, 7.0, 1.0});
             optimize::JacobianAnswer answer;
             answer.jacobian.resize(2, 5);
             for (Eigen::Index j = 0; j < 5; ++j) {
               answer.jacobian(0, j) = 0.0624;
               answer.jacobian(1, j) = -3.0 * c[j] / std::pow(x[j], 4);
             }
             return answer;
           }},
          1.3399564,
          vector_of({6.0160, 5.3092, 4.4943, 3.5015, 2.1527}),
          false};
}

}  // namespace

VectorX vector_of(std::initializer_list<double> numbers) {
  VectorX v(static_cast<Eigen::Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), v.data());
  return v;
}

std::vector<StandardProblem> standard_problems() {
  return {rosenbrock(), hs6(), hs24(), hs35(), hs43(), hs71(), cantilever()};
}

StandardProblem camel(double x, double y) {
  return {"camel",
          {{{"x", x, -3.0, 3.0}, {"y", y, -2.0, 2.0}},
           "height",
           {},
           [](const VectorX& p) {
             const double a = sqr(p[0]);
             const double b = sqr(p[1]);
             return values({(4.0 - 2.1 * a + a * a / 3.0) * a + p[0] * p[1] +
                            4.0 * (b - 1.0) * b});
           },
           {}},
          -1.0316284535,
          vector_of({0.0898420, -0.7126564}),
          false};
}

StandardProblem fenced_camel() {
  StandardProblem fenced = camel(-1.6, 1.7);
  fenced.name = "fenced camel";
  fenced.problem.constraints = {{"sum", 0.0, kInf, 1.0}};
  const optimize::VectorFunction open = fenced.problem.function;
  fenced.problem.function = [open](const VectorX& p) {
    return values({open(p).values[0], p[0] + p[1]});
  };
  fenced.solution = vector_of({-0.0898420, 0.7126564});
  return fenced;
}

}  // namespace meniscus::tests
