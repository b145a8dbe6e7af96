/// Where other programs are: those of the system, and this program's own
/// helpers (core/child_process.h runs them).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace meniscus {

/// An executable file of this name in PATH, or `name` itself if it has a '/'.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// A helper of this program: the path in the environment variable `variable`
/// if that is set, else in the folders that were added, else beside the
/// running program, else in ../libexec/meniscus from there, else where it was
/// installed. Nothing when it is not executable there.
std::optional<std::filesystem::path> find_helper(const std::string& name,
                                                 const std::string& variable);

/// The same; IoError when it is not there, with where it was looked for and
/// `advice`, or with what the variable says.
std::string require_helper(const std::string& name, const std::string& variable,
                           const std::string& advice);

/// One more folder of helpers, for a library within another program, before
/// any other thread looks for one.
void add_helper_folder(const std::string& folder);

}  // namespace meniscus
