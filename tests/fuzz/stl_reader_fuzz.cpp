// libFuzzer harness of the STL reader, ASCII and binary: a mesh whose facets
// name its points, or InvalidInput.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "io/read_stl.h"
#include "tests/fuzz/sound_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    meniscus::require_sound(meniscus::io::read_stl_text(text, "fuzz.stl"));
  } catch (const meniscus::InvalidInput&) {
  }
  return 0;
}
