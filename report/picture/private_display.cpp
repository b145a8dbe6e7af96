#include "report/picture/private_display.h"

#include <array>
#include <cctype>
#include <cstdlib>

#include <sys/random.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/find_program.h"

namespace meniscus::picture {

namespace fs = std::filesystem;

namespace {

constexpr double kDisplayStart = 15.0;  // [s], a busy machine included

/// A key of X for any display and host (Xau's format: family, then address,
/// display, kind and key, each behind its length in two bytes, high one first);
/// false where it cannot be written.
bool write_display_key(const fs::path& file) {
  std::array<char, 16> key;
  if (::getrandom(key.data(), key.size(), 0) !=
      static_cast<ssize_t>(key.size())) {
    return false;
  }
  constexpr std::string_view kKind = "MIT-MAGIC-COOKIE-1";
  std::string bytes("\xff\xff\0\0\0\0", 6);  // any family, no address, any
  for (const std::string_view part :
       {kKind, std::string_view(key.data(), key.size())}) {
    bytes += '\0';
    bytes += static_cast<char>(part.size());
    bytes += part;
  }
  try {
    write_file(file, bytes);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

}  // namespace

PrivateFolder::PrivateFolder() {
  std::error_code failed;
  std::string name =
      (fs::temp_directory_path(failed) / "meniscus-XXXXXX").string();
  if (!failed && mkdtemp(name.data()) != nullptr) {
    path_ = name;
  }
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  if (!path_.empty()) {
    fs::remove_all(path_, ignored);
  }
}

PrivateDisplay::PrivateDisplay(int niceness) : key_(folder_.path() / "key") {
  if (!find_program("Xvfb")) {
    problem_ = "Xvfb is not installed (Debian package xvfb)";
  } else if (folder_.path().empty() || !write_display_key(key_)) {
    problem_ =
        "a display's key cannot be written: there is no folder for temporary "
        "files (TMPDIR)";
  } else {
    start_server(niceness);
  }
  const char* own = std::getenv("DISPLAY");
  if (!server_ && own != nullptr) {
    name_ = own;
  }
}

void PrivateDisplay::start_server(int niceness) {
  ChildOptions options;
  options.niceness = niceness;
  // The server picks a free number and prints it when it is ready.
  options.argv = {"Xvfb",     "-displayfd", "1",         "-screen",
                  "0",        "64x64x24",   "-nolisten", "tcp",
                  "-noreset", "-auth",      key_};
  try {
    auto server = std::make_unique<BackgroundChild>(options);
    const auto line = server->read_line(kDisplayStart);
    if (line && !line->empty() &&
        std::isdigit(static_cast<unsigned char>(line->front())) != 0) {
      server_ = std::move(server);
      name_ = ":" + *line;
    } else {
      problem_ = "Xvfb did not start";
    }
  } catch (const Error& error) {
    problem_ = error.what();
  }
}

std::vector<std::pair<std::string, std::optional<std::string>>>
PrivateDisplay::environment() const {
  std::vector<std::pair<std::string, std::optional<std::string>>> variables = {
      {"DISPLAY", name_}};
  // No home folder is needed, nothing is left in it.
  if (folder_.path().empty()) {
    variables.emplace_back("MESA_SHADER_CACHE_DISABLE", "true");
  } else {
    variables.emplace_back("MESA_SHADER_CACHE_DIR", folder_.path().string());
  }
  if (server_) {
    variables.emplace_back("LIBGL_ALWAYS_SOFTWARE", "1");
    variables.emplace_back("XAUTHORITY", key_.string());
  }
  return variables;
}

}  // namespace meniscus::picture
