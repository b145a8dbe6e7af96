#include "fea/solver/preconditioner.h"

#include <algorithm>

#include "fea/solver/free_factor.h"

namespace meniscus::solver {

namespace {

class Direct final : public Preconditioner {
 public:
  Direct(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
         const NodeFreedom& freedom)
      : factor_(pattern, matrix, freedom) {}

  void apply(const std::vector<double>& r, std::vector<double>& z,
             int K) const override {
    std::fill(z.begin(), z.end(), 0.0);
    factor_.solve(r.data(), z.data(), K);
  }

 private:
  FreeFactor factor_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_direct(const BlockPattern& pattern,
                                            const BlockMatrix<double>& matrix,
                                            const NodeFreedom& freedom) {
  return std::make_unique<Direct>(pattern, matrix, freedom);
}

}  // namespace meniscus::solver
