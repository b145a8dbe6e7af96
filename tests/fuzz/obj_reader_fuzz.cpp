// libFuzzer harness of the OBJ reader: a mesh whose facets name its points, or
// InvalidInput.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "io/obj.h"
#include "tests/fuzz/sound_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    meniscus::require_sound(meniscus::io::read_obj_text(text, "fuzz.obj"));
  } catch (const meniscus::InvalidInput&) {
  }
  return 0;
}
