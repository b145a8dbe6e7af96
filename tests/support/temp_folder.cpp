#include "tests/support/temp_folder.h"

#include <stdexcept>
#include <stdlib.h>

namespace meniscus {

namespace fs = std::filesystem;

TempFolder::TempFolder() {
  std::string name =
      (fs::temp_directory_path() / "meniscus tést XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make the folder " + name);
  }
  path_ = name;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace meniscus
