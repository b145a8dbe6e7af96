#include "evolve/datafile/fe_bodies.h"

#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "evolve/datafile/fe_formulas.h"

namespace meniscus::datafile {

namespace {

struct EdgeUse {
  int face = 0;        // index
  bool along = false;  // seen from outside the body
};

bool is_held(const FeMarks& marks) {
  return marks.fixed || marks.boundary >= 0 || !marks.constraints.empty();
}

/// The body's faces at each edge.
std::vector<std::vector<EdgeUse>> uses_of(const FeFile& file,
                                          const FeBody& body) {
  std::vector<std::vector<EdgeUse>> uses(file.edges.size());
  for (const int signed_face : body.faces) {
    const int f = std::abs(signed_face) - 1;
    for (const int signed_edge : file.faces[f].edges) {
      uses[std::abs(signed_edge) - 1].push_back(
          {f, (signed_edge > 0) == (signed_face > 0)});
    }
  }
  return uses;
}

}  // namespace

void check_fe_bodies(const FeFile& file) {
  bool walls = false;  // constraints that all vertices are on
  for (const FeConstraint& constraint : file.constraints) {
    walls = walls || constraint.global;
  }
  for (const FeBody& body : file.bodies) {
    const std::vector<std::vector<EdgeUse>> uses = uses_of(file, body);
    for (std::size_t e = 0; e < uses.size(); ++e) {
      const std::vector<EdgeUse>& at = uses[e];
      const int edge = file.edges[e].id;
      if (at.size() == 2 && at[0].along == at[1].along &&
          at[0].face != at[1].face) {
        fe_fail(file, body.place,
                fmt::format("body {}: faces {} and {} run along edge {} the "
                            "same way, so one of them is inside out; give it "
                            "the other sign in the body",
                            body.id, file.faces[at[0].face].id,
                            file.faces[at[1].face].id, edge));
      }
      if (at.size() == 1 && !walls && !is_held(file.edges[e].marks) &&
          !is_held(file.faces[at[0].face].marks)) {
        fe_fail(file, body.place,
                fmt::format("body {} is not closed: only its face {} is at "
                            "edge {}, which nothing holds; add the face that "
                            "is missing to the body, or make the edge fixed or "
                            "put it on a constraint or boundary",
                            body.id, file.faces[at[0].face].id, edge));
      }
    }
  }
}

}  // namespace meniscus::datafile
