/// A stable 128-bit fingerprint of a text (FNV-1a), as 32 hex digits. Not
/// cryptographic: it tells one case from another, not friend from foe.
#pragma once

#include <string>
#include <string_view>

namespace meniscus::files {

std::string content_hash(std::string_view text);

}  // namespace meniscus::files
