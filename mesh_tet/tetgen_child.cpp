#include "mesh_tet/tetgen_child.h"

#include <cstring>

#include <fmt/format.h>

#include "core/child_process.h"
#include "core/error.h"
#include "core/find_program.h"
#include "mesh_tet/tetgen_protocol.h"

namespace meniscus::mesh_tet {

namespace {

constexpr const char* kHelper = "meniscus-tetgen";
constexpr const char* kVariable = "MENISCUS_TETGEN";

std::string find_tetgen() {
  return require_helper(
      kHelper, kVariable,
      fmt::format("install it in one of these places or set {} to its path",
                  kVariable));
}

void append(std::string& bytes, const void* data, std::size_t size) {
  if (size > 0) {
    bytes.append(static_cast<const char*>(data), size);
  }
}

std::string encode(const TetgenInput& input) {
  tetgen::Request request;
  request.points = static_cast<std::int64_t>(input.points->size());
  request.facets = static_cast<std::int64_t>(input.facets->size());
  request.holes = static_cast<std::int64_t>(input.holes.size());
  if (input.elements != nullptr) {
    request.elements = static_cast<std::int64_t>(input.elements->size() / 4);
  }
  if (input.switches.size() >= sizeof request.switches) {
    throw InvalidInput(
        fmt::format("TetGen switches '{}' are longer than {} characters",
                    input.switches, sizeof request.switches - 1));
  }
  std::memcpy(request.switches, input.switches.data(), input.switches.size());
  std::string bytes;
  append(bytes, &request, sizeof request);
  append(bytes, input.points->data(), sizeof(Vec3) * input.points->size());
  append(bytes, input.facets->data(), sizeof(Triangle) * input.facets->size());
  append(bytes, input.holes.data(), sizeof(Vec3) * input.holes.size());
  if (input.elements != nullptr) {
    append(bytes, input.elements->data(), sizeof(int) * input.elements->size());
    append(bytes, input.largest->data(),
           sizeof(double) * input.largest->size());
  }
  append(bytes, &tetgen::kEndMark, sizeof tetgen::kEndMark);
  return bytes;
}

/// Empty when the bytes are a whole, sound reply; else what is wrong.
std::string decode(const std::string& bytes, TetgenOutput& output) {
  tetgen::Reply reply;
  constexpr std::size_t kFrame = sizeof reply + sizeof tetgen::kEndMark;
  if (bytes.size() < kFrame) {
    return fmt::format("its reply has only {} bytes", bytes.size());
  }
  std::memcpy(&reply, bytes.data(), sizeof reply);
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  if (reply.magic != tetgen::kMagic || reply.nodes < 0 || reply.elements < 0 ||
      reply.nodes > kMost || reply.elements > kMost) {
    return "its reply is of another kind or version; install program and "
           "helper from one build";
  }
  const std::size_t node_bytes = sizeof(Vec3) * reply.nodes;
  const std::size_t element_bytes = 4 * sizeof(int) * reply.elements;
  std::uint64_t mark = 0;
  std::memcpy(&mark, bytes.data() + bytes.size() - sizeof mark, sizeof mark);
  if (bytes.size() != kFrame + node_bytes + element_bytes ||
      mark != tetgen::kEndMark) {
    return fmt::format("its reply was cut off at {} bytes", bytes.size());
  }
  output.nodes.resize(reply.nodes);
  output.elements.resize(4 * reply.elements);
  const char* at = bytes.data() + sizeof reply;
  if (node_bytes > 0) {
    std::memcpy(output.nodes.data()->data(), at, node_bytes);
  }
  if (element_bytes > 0) {
    std::memcpy(output.elements.data(), at + node_bytes, element_bytes);
  }
  for (const int node : output.elements) {
    if (node < 0 || node >= reply.nodes) {
      return fmt::format("its reply names node {} of {}", node, reply.nodes);
    }
  }
  if (!flat(output.nodes).allFinite()) {
    return "its reply has coordinates that are not finite";
  }
  return {};
}

std::string last_line(std::string text) {
  while (!text.empty() &&
         std::isspace(static_cast<unsigned char>(text.back()))) {
    text.pop_back();
  }
  const auto start = text.find_last_of('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

std::string describe_failure(const ChildResult& child,
                             const TetgenLimits& limits) {
  if (child.timed_out) {
    return fmt::format(
        "TetGen was ended at its time limit of {} s; raise the limit, or the "
        "element edge",
        limits.time);
  }
  constexpr const char* kMemory =
      "TetGen ran out of its memory limit of {:.3g} MB; raise the limit, or "
      "the element edge";
  constexpr const char* kReport =
      "this is a fault inside TetGen; another element edge often helps";
  switch (child.exit_code) {
    case tetgen::kBadRequest:
      return "TetGen's helper did not understand the request; install program "
             "and helper from one build";
    case tetgen::kOutOfMemory:
    case tetgen::kTetgenCode + 1:
      return fmt::format(kMemory, limits.memory / 1e6);
    case tetgen::kTetgenCode + 2:
      return fmt::format("TetGen met an internal error; {}", kReport);
    case tetgen::kTetgenCode + 3:
      return "TetGen found that the surface crosses itself";
    case tetgen::kTetgenCode + 4:
      return "TetGen found a feature too small for its tolerance; remesh the "
             "surface without needle facets";
    case tetgen::kTetgenCode + 5:
      return "TetGen found two facets too close to each other; move them "
             "apart or remesh finer there";
    default:
      break;
  }
  // Too little even to load the program, whatever ends it then.
  constexpr double kLeastMemory = 32e6;
  if (limits.memory < kLeastMemory) {
    return fmt::format(kMemory, limits.memory / 1e6);
  }
  const std::string said = last_line(child.error_tail);
  return fmt::format("TetGen's process was {}{}{}; {}", describe_end(child),
                     said.empty() ? "" : ", saying: ", said, kReport);
}

}  // namespace

TetgenOutput run_tetgen(const TetgenInput& input, const TetgenLimits& limits) {
  const std::string request = encode(input);
  ChildOptions options;
  options.argv = {find_tetgen()};
  options.environment = {{"LC_ALL", "C"}};  // "%g" and strtod with a point
  options.input = request;
  options.time_limit = limits.time;
  options.memory_limit = limits.memory;
  options.monitor = limits.monitor;
  const ChildResult child = run_child(options);
  if (child.stopped) {
    throw Interrupted("stopped on request while TetGen was running");
  }
  TetgenOutput output;
  if (!child.succeeded()) {
    output.failure = describe_failure(child, limits);
    return output;
  }
  const std::string wrong = decode(child.output, output);
  if (!wrong.empty()) {
    output = {};
    output.failure = fmt::format("TetGen's helper ended well, but {}", wrong);
  }
  return output;
}

}  // namespace meniscus::mesh_tet
