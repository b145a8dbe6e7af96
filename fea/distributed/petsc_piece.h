/// One process's part of an elastic system, as meniscus-petsc reads it. Throws
/// std::runtime_error with what is wrong.
#pragma once

#include <filesystem>
#include <vector>

#include "fea/distributed/petsc_protocol.h"
#include "fea/element/elastic_law.h"

namespace meniscus::distributed::petsc {

/// Held directions and springs, by local node.
struct PieceGroup {
  std::vector<int> held;
  std::vector<double> projector;  // 9 each, symmetric
  std::vector<int> spring_at;     // 2 each
  std::vector<double> spring;     // 9 each, symmetric
  bool start = false;
  std::vector<std::vector<double>> force;         // per load case, 3 per node
  std::vector<std::vector<double>> displacement;  // with start
};

struct Piece {
  PieceHeader header;
  std::vector<int> ghost;                // ids of nodes, ascending
  std::vector<double> x;                 // 3 per local node
  std::vector<int> elements;             // local ids
  std::vector<int> region;               // per element
  std::vector<element::ElasticLaw> law;  // per region; what elements need of it
  std::vector<PieceGroup> groups;

  int local_nodes() const {
    return static_cast<int>(header.own + header.ghosts);
  }
  /// Id in the whole part of a local node.
  std::int64_t id(int local) const {
    return local < header.own ? header.first + local
                              : ghost[local - header.own];
  }
};

Piece read_piece(const std::filesystem::path& path);

}  // namespace meniscus::distributed::petsc
