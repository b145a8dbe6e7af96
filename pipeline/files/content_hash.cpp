#include "pipeline/files/content_hash.h"

#include <cstdint>

#include <fmt/format.h>

namespace meniscus::files {

std::string content_hash(std::string_view text) {
  // Offset basis and prime of the 128-bit FNV-1a hash (Fowler, Noll, Vo).
  __extension__ using Wide = unsigned __int128;
  Wide hash =
      (static_cast<Wide>(0x6c62272e07bb0142ULL) << 64) | 0x62b821756295c58dULL;
  const Wide prime = (static_cast<Wide>(0x0000000001000000ULL) << 64) | 0x13bU;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= prime;
  }
  return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(hash >> 64),
                     static_cast<std::uint64_t>(hash));
}

}  // namespace meniscus::files
