/// A dense matrix that waits on the disk until it is needed.
#pragma once

#include <cstdio>
#include <memory>

#include <Eigen/Core>

namespace meniscus {

/// Its file has no name and is gone with it: in the folder for temporary files
/// (TMPDIR).
class SpilledMatrix {
 public:
  /// Throws IoError, naming the folder, where it does not hold the file.
  /// Leading columns of another matrix are not copied first.
  explicit SpilledMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

  /// The same bits. From any number of threads. Throws IoError.
  Eigen::MatrixXd read() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  Eigen::Index rows_, columns_;
};

}  // namespace meniscus
