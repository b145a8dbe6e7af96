/// A folder of a test's own, removed with all it holds.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace meniscus {

class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name) {
    path_ = (std::filesystem::temp_directory_path() /
             ("meniscus test ü " + name + " XXXXXX"))
                .string();
    if (mkdtemp(path_.data()) == nullptr) {
      std::abort();
    }
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace meniscus
