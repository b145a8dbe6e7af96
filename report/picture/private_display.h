/// A display for the helper that draws: a virtual one of our own (Xvfb), which
/// opens to its own key only, else the user's.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/child_process.h"

namespace meniscus::picture {

/// A folder that nobody else may look into: for the display's key, and for the
/// renderer's compiled shaders.
class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  /// Empty where there is none.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Ended with the object, as with the thread that made it.
class PrivateDisplay {
 public:
  /// `niceness`: of the server, as in ChildOptions.
  explicit PrivateDisplay(int niceness);

  /// ":7"; empty where there is none, and then why.
  const std::string& name() const { return name_; }
  const std::string& problem() const { return problem_; }

  /// What a program that draws there needs in its environment.
  std::vector<std::pair<std::string, std::optional<std::string>>> environment()
      const;

 private:
  void start_server(int niceness);

  PrivateFolder folder_;
  std::filesystem::path key_;  // who has it may look and draw
  std::unique_ptr<BackgroundChild> server_;
  std::string name_;
  std::string problem_;
};

}  // namespace meniscus::picture
