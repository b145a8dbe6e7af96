/// Files that appear whole or not at all: the bytes go into a hidden file
/// beside the target, reach the disk, and are then renamed over it. A kill, a
/// crash or a full disk leaves the old file (or none) and never half a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace meniscus {

/// Replaces or creates `path`. Throws IoError (path, the system's reason,
/// advice) and then leaves `path` as it was and nothing beside it. A path that
/// exists and is no regular file (folder, device) is refused.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Removes the hidden files in `folder` that write_file() left when it was
/// killed: those of processes that are no more. What cannot be removed stays.
void remove_leftovers(const std::filesystem::path& folder);

/// The bytes of a file. Throws IoError.
std::string read_file(const std::filesystem::path& path);

/// Makes the folder and its parents if missing. Throws IoError when that
/// fails or when no file can be made in it.
void make_folder(const std::filesystem::path& folder);

/// "cannot DOING 'PATH': REASON; ADVICE" for an errno value.
std::string describe_io_error(const std::string& doing,
                              const std::filesystem::path& path, int error);

}  // namespace meniscus
