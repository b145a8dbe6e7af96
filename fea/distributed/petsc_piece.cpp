#include "fea/distributed/petsc_piece.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace meniscus::distributed::petsc {

namespace {

constexpr std::int64_t kMost = std::int64_t{1} << 31;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : in_(path, std::ios::binary), name_(path.string()) {
    if (!in_) {
      refuse("cannot be opened");
    }
  }

  [[noreturn]] void refuse(const char* what) const {
    throw std::runtime_error(name_ + " " + what);
  }

  template <class T>
  T one() {
    T value;
    read(&value, sizeof value);
    return value;
  }

  template <class T>
  std::vector<T> list(std::int64_t count) {
    if (count < 0 || count >= kMost) {
      refuse("is of another kind or version");
    }
    std::vector<T> values(static_cast<std::size_t>(count));
    read(values.data(), sizeof(T) * values.size());
    return values;
  }

  std::vector<int> ids(std::int64_t count, std::int64_t below) {
    std::vector<int> values = list<int>(count);
    if (std::any_of(values.begin(), values.end(),
                    [&](int id) { return id < 0 || id >= below; })) {
      refuse("names a node or region that is not there");
    }
    return values;
  }

 private:
  void read(void* data, std::size_t size) {
    in_.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
    if (!in_) {
      refuse("is cut off");
    }
  }

  std::ifstream in_;
  std::string name_;
};

element::ElasticLaw law_of(const Law& given) {
  element::ElasticLaw law;
  law.isotropic = given.isotropic != 0.0;
  law.lame.lambda = given.lambda;
  law.lame.mu = given.mu;
  std::copy(given.tensor, given.tensor + 81, law.tensor.data());
  return law;
}

PieceGroup read_group(Reader& in, const Piece& piece) {
  const auto header = in.one<GroupHeader>();
  PieceGroup group;
  group.held = in.ids(header.held, piece.local_nodes());
  group.projector = in.list<double>(9 * header.held);
  group.spring_at = in.ids(2 * header.springs, piece.local_nodes());
  group.spring = in.list<double>(9 * header.springs);
  group.start = header.start != 0;
  for (std::int64_t c = 0; c < header.cases; ++c) {
    group.force.push_back(in.list<double>(3 * piece.header.own));
    if (group.start) {
      group.displacement.push_back(in.list<double>(3 * piece.header.own));
    }
  }
  return group;
}

}  // namespace

Piece read_piece(const std::filesystem::path& path) {
  Reader in(path);
  Piece piece;
  PieceHeader& h = piece.header;
  h = in.one<PieceHeader>();
  if (h.magic != kMagic || h.own < 0 || h.ghosts < 0 || h.own >= kMost ||
      h.ghosts >= kMost || h.first < 0 || h.first + h.own > h.nodes ||
      (h.nodes_per_element != 4 && h.nodes_per_element != 10)) {
    in.refuse("is of another kind or version");
  }
  piece.ghost = in.ids(h.ghosts, h.nodes);
  piece.x = in.list<double>(3 * (h.own + h.ghosts));
  piece.elements = in.ids(h.elements * h.nodes_per_element, h.own + h.ghosts);
  piece.region = in.ids(h.elements, h.regions);
  for (const Law& given : in.list<Law>(h.regions)) {
    piece.law.push_back(law_of(given));
  }
  for (std::int64_t g = 0; g < h.groups; ++g) {
    piece.groups.push_back(read_group(in, piece));
  }
  if (in.one<std::uint64_t>() != kEndMark) {
    in.refuse("has no end mark");
  }
  return piece;
}

}  // namespace meniscus::distributed::petsc
