/// Dense matrices that wait on the disk until they are needed.
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include <Eigen/Core>

namespace meniscus {

/// Its file has no name and is gone with it: in the folder for temporary files
/// (TMPDIR).
class SpilledMatrix {
 public:
  /// Throws IoError, naming the folder, where it does not hold the file.
  explicit SpilledMatrix(const Eigen::MatrixXd& matrix);

  /// Some of its columns, the same bits. From any number of threads. Throws
  /// IoError.
  Eigen::MatrixXd read(Eigen::Index first, Eigen::Index count) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  Eigen::Index rows_;
};

/// One of many, some of which memory has room for.
class StoredMatrix {
 public:
  /// `spill`: on the disk. Throws as SpilledMatrix does.
  StoredMatrix(Eigen::MatrixXd matrix, bool spill);

  /// For some columns at a time: visit(first column, columns).
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    constexpr Eigen::Index kColumns = 512;
    for (Eigen::Index first = 0; first < columns_; first += kColumns) {
      const Eigen::Index count = std::min(kColumns, columns_ - first);
      if (on_disk_) {
        visit(first, on_disk_->read(first, count));
      } else {
        visit(first, in_memory_.middleCols(first, count));
      }
    }
  }
  /// In memory.
  double bytes() const {
    return sizeof(double) * static_cast<double>(in_memory_.size());
  }
  /// `read`: place for one that is on the disk.
  const Eigen::MatrixXd& get(Eigen::MatrixXd& read) const;

 private:
  Eigen::Index columns_;
  Eigen::MatrixXd in_memory_;
  std::optional<SpilledMatrix> on_disk_;
};

}  // namespace meniscus
