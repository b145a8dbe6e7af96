// meniscus-tetgen: fills one surface with tetrahedra. A program of its own,
// because TetGen 1.5 ends its process on some inputs; the only file that sees
// TetGen. Reads a request on stdin, writes a reply on stdout
// (mesh_tet/tetgen_protocol.h).
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <new>
#include <numeric>
#include <tetgen.h>
#include <typeinfo>
#include <unistd.h>
#include <vector>

#include "mesh_tet/tetgen_protocol.h"

namespace {

using namespace meniscus::mesh_tet::tetgen;

constexpr std::int64_t kMostItems = 200'000'000;

[[noreturn]] void end(int code) { ::_exit(code); }

void read_all(void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(STDIN_FILENO, at, size);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      end(kBadRequest);
    }
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

void write_all(int out, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::write(out, at, size);
    if (sent < 0 && errno == EINTR) {
      continue;
    }
    if (sent <= 0) {
      end(kNotDelivered);
    }
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

/// Keeps the reply's stream for itself: TetGen prints on stdout.
int take_stdout() {
  const int out = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (out < 0 || null < 0 || ::dup2(null, STDOUT_FILENO) < 0) {
    end(kNotDelivered);
  }
  return out;
}

struct Surface {
  Request request;
  std::vector<double> points;
  std::vector<int> facets;
  std::vector<double> holes;
  std::vector<int> elements;    // to refine
  std::vector<double> largest;  // volume of each
  std::vector<int> markers;     // of facets; TetGen joins those of one plane
                                // and marker
  std::vector<tetgenio::polygon> polygons;
  std::vector<tetgenio::facet> borders;
};

Surface read_surface() {
  Surface surface;
  Request& r = surface.request;
  read_all(&r, sizeof r);
  const auto sane = [](std::int64_t n) { return n >= 0 && n <= kMostItems; };
  if (r.magic != kMagic || !sane(r.points) || !sane(r.facets) ||
      !sane(r.holes) || !sane(r.elements) ||
      r.switches[kSwitchesSize - 1] != 0) {
    end(kBadRequest);
  }
  surface.points.resize(3 * static_cast<std::size_t>(r.points));
  surface.facets.resize(3 * static_cast<std::size_t>(r.facets));
  surface.holes.resize(3 * static_cast<std::size_t>(r.holes));
  surface.elements.resize(4 * static_cast<std::size_t>(r.elements));
  surface.largest.resize(static_cast<std::size_t>(r.elements));
  const auto read = [](auto& list) {
    read_all(list.data(), sizeof(list[0]) * list.size());
  };
  read(surface.points);
  read(surface.facets);
  read(surface.holes);
  read(surface.elements);
  read(surface.largest);
  std::uint64_t mark = 0;
  read_all(&mark, sizeof mark);
  if (mark != kEndMark) {
    end(kBadRequest);
  }
  const auto outside = [](const std::vector<int>& ids, std::int64_t count) {
    return std::any_of(ids.begin(), ids.end(),
                       [&](int id) { return id < 0 || id >= count; });
  };
  if (outside(surface.facets, r.points) ||
      outside(surface.elements, r.points)) {
    end(kBadRequest);
  }
  return surface;
}

/// Borrowed arrays; the process ends before a destructor would free them.
tetgenio& hand_over(Surface& surface) {
  static tetgenio& in = *new tetgenio;
  const auto facet_count = static_cast<std::size_t>(surface.request.facets);
  in.firstnumber = 0;
  in.pointlist = surface.points.data();
  in.numberofpoints = static_cast<int>(surface.request.points);
  if (surface.request.elements > 0) {
    surface.markers.resize(facet_count);
    std::iota(surface.markers.begin(), surface.markers.end(), 1);
    in.tetrahedronlist = surface.elements.data();
    in.numberoftetrahedra = static_cast<int>(surface.request.elements);
    in.numberofcorners = 4;
    in.tetrahedronvolumelist = surface.largest.data();
    in.trifacelist = surface.facets.data();
    in.trifacemarkerlist = surface.markers.data();
    in.numberoftrifaces = static_cast<int>(facet_count);
    return in;
  }
  std::vector<tetgenio::polygon>& polygons = surface.polygons;
  std::vector<tetgenio::facet>& facets = surface.borders;
  polygons.resize(facet_count);
  facets.resize(facet_count);
  for (std::size_t f = 0; f < facet_count; ++f) {
    polygons[f] = {surface.facets.data() + 3 * f, 3};
    facets[f] = {&polygons[f], 1, nullptr, 0};
  }
  in.facetlist = facets.data();
  in.numberoffacets = static_cast<int>(facet_count);
  in.holelist = surface.holes.data();
  in.numberofholes = static_cast<int>(surface.request.holes);
  return in;
}

void fill(Surface& surface, int out) {
  tetgenio& in = hand_over(surface);
  static tetgenio& result = *new tetgenio;
  tetrahedralize(surface.request.switches, &in, &result);

  Reply reply;
  reply.nodes = result.numberofpoints;
  reply.elements = result.numberoftetrahedra;
  if (reply.elements > 0 && result.numberofcorners != 4) {
    end(kBadRequest);
  }
  write_all(out, &reply, sizeof reply);
  write_all(out, result.pointlist,
            3 * sizeof(double) * static_cast<std::size_t>(reply.nodes));
  write_all(out, result.tetrahedronlist,
            4 * sizeof(int) * static_cast<std::size_t>(reply.elements));
  write_all(out, &kEndMark, sizeof kEndMark);
}

}  // namespace

/// TetGen reports errors by throwing an int, but frees its memory before and
/// once more while unwinding, so a handler would never be reached. Its code
/// is taken here, where it is thrown; everything else goes on as usual.
extern "C" void __cxa_throw(  // NOLINT: the runtime's own name
    void* thrown, void* type, void (*destroy)(void*)) {
  if (*static_cast<std::type_info*>(type) == typeid(int)) {
    int code = 0;
    std::memcpy(&code, thrown, sizeof code);
    end(kTetgenCode + code);
  }
  using Throw = void (*)(void*, void*, void (*)(void*));
  static const auto real =
      reinterpret_cast<Throw>(::dlsym(RTLD_NEXT, "__cxa_throw"));
  real(thrown, type, destroy);
  __builtin_unreachable();
}

int main() {
  const int out = take_stdout();
  try {
    Surface surface = read_surface();
    fill(surface, out);
  } catch (const std::bad_alloc&) {
    end(kOutOfMemory);
  }
  end(kDone);
}
