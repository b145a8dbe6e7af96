#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "io/deck/deck_mesh.h"

namespace meniscus::deck {

namespace {

// Names of faces for the eye; surfaces and node sets beyond these give none.
constexpr std::size_t kMostLabels = 256;
constexpr int kMostSets = 1000;

/// Corners of the face that has not corner `off`, outward.
constexpr std::array<std::array<int, 3>, 4> kOutward = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// A face as one of its elements has it.
struct ElementFace {
  std::array<int, 3> corners{};  // ascending
  int element = 0;
  int off = 0;
};

std::vector<ElementFace> sorted_faces(const TetMesh& mesh) {
  std::vector<ElementFace> faces;
  faces.reserve(4 * static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (int off = 0; off < 4; ++off) {
      ElementFace face{{}, e, off};
      for (std::size_t k = 0; k < 3; ++k) {
        face.corners[k] = ids[static_cast<std::size_t>(
            kOutward[static_cast<std::size_t>(off)][k])];
      }
      std::sort(face.corners.begin(), face.corners.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const ElementFace& a, const ElementFace& b) {
              return std::tie(a.corners, a.element) <
                     std::tie(b.corners, b.element);
            });
  return faces;
}

/// Which surface, of those that the deck names, has each face of an element:
/// the first; -1 for none. Four entries per element.
std::vector<int> surfaces_of_faces(const DeckCards& cards,
                                   const FrozenModel& frozen,
                                   std::size_t elements) {
  std::vector<int> surface(4 * elements, -1);
  const std::vector<std::string>& names = frozen.model.surface_names;
  for (std::size_t s = 0; s < names.size(); ++s) {
    for (const RawFace& face : frozen.model.surfaces.at(names[s])) {
      for (const int e :
           elements_named(cards, frozen, face.at, face.elements)) {
        int& first = surface[4 * static_cast<std::size_t>(e) +
                             static_cast<std::size_t>(face.opposite_corner)];
        first = first < 0 && s < kMostLabels ? static_cast<int>(s) : first;
      }
    }
  }
  return surface;
}

std::string free_name(std::string name, const std::vector<std::string>& taken) {
  while (std::find(taken.begin(), taken.end(), name) != taken.end()) {
    name += "_";
  }
  return name;
}

/// Gives faces without a label that of the node sets that have all of their
/// nodes.
class NodeSetLabels {
 public:
  NodeSetLabels(const DeckCards& cards, const FrozenModel& frozen,
                TetMesh& mesh)
      : cards_(cards),
        frozen_(frozen),
        mesh_(mesh),
        marked_(mesh.nodes.size(), -1) {}

  void add() {
    const DeckSets& sets = frozen_.model.node_sets;
    for (const std::string& name : sets.names()) {
      if (mesh_.labels.size() >= kMostLabels || set_ > kMostSets) {
        return;
      }
      const std::vector<int> places =
          sets.places(cards_, DeckPlace{}, name, frozen_.model.node_numbers);
      if (places.size() < mesh_.nodes.size()) {
        add_set(name, places);
      }
    }
  }

 private:
  void add_set(const std::string& name, const std::vector<int>& places) {
    const int label = static_cast<int>(mesh_.labels.size());
    ++set_;
    for (const int place : places) {
      const int node = frozen_.node_of[static_cast<std::size_t>(place)];
      if (node >= 0) {
        marked_[static_cast<std::size_t>(node)] = set_;
      }
    }
    bool any = false;
    for (int f = 0; f < mesh_.face_count(); ++f) {
      int& own = mesh_.face_label[static_cast<std::size_t>(f)];
      const auto ids = mesh_.face(f);
      if (own < 0 && std::all_of(ids.begin(), ids.end(), [&](int node) {
            return marked_[static_cast<std::size_t>(node)] == set_;
          })) {
        own = label;
        any = true;
      }
    }
    if (any) {
      mesh_.labels.push_back(free_name(shown_field(name), mesh_.labels));
    }
  }

  const DeckCards& cards_;
  const FrozenModel& frozen_;
  TetMesh& mesh_;
  int set_ = -1;             // under way, counted
  std::vector<int> marked_;  // the last set that has the node
};

/// The corner of the element that the face has not.
int corner_off(const TetMesh& mesh, int face) {
  const auto ids = mesh.face(face);
  const auto element =
      mesh.element(mesh.face_element[static_cast<std::size_t>(face)]);
  for (int c = 0; c < 3; ++c) {
    if (std::find(ids.begin(), ids.begin() + 3,
                  element[static_cast<std::size_t>(c)]) == ids.begin() + 3) {
      return c;
    }
  }
  return 3;
}

}  // namespace

std::vector<int> nodes_of_face(const TetMesh& mesh, int element, int off) {
  const auto ids = mesh.element(element);
  const std::array<int, 3>& local = kOutward[static_cast<std::size_t>(off)];
  std::vector<int> nodes;
  nodes.reserve(6);
  for (const int c : local) {
    nodes.push_back(ids[static_cast<std::size_t>(c)]);
  }
  for (std::size_t k = 0; mesh.order == 2 && k < 3; ++k) {
    const int a = std::min(local[k], local[(k + 1) % 3]);
    const int b = std::max(local[k], local[(k + 1) % 3]);
    const auto at = std::find(kTetEdges.begin(), kTetEdges.end(), Edge{a, b});
    nodes.push_back(ids[4 + static_cast<std::size_t>(at - kTetEdges.begin())]);
  }
  return nodes;
}

void add_deck_faces(const DeckCards& cards,
                    const std::vector<std::array<int, 2>>& element_places,
                    TetMesh& mesh) {
  const auto region = [&](const ElementFace& face) {
    return mesh.element_region[static_cast<std::size_t>(face.element)];
  };
  const std::vector<ElementFace> faces = sorted_faces(mesh);
  for (std::size_t k = 0; k < faces.size();) {
    std::size_t end = k + 1;
    while (end < faces.size() && faces[end].corners == faces[k].corners) {
      ++end;
    }
    if (end - k > 2) {
      const auto& [file, line] =
          element_places[static_cast<std::size_t>(faces[k + 2].element)];
      cards.refuse({file, line},
                   "this element has a face that two elements "
                   "before it have already");
    }
    if (end - k == 1 || region(faces[k]) != region(faces[k + 1])) {
      const bool swap = end - k == 2 && region(faces[k + 1]) < region(faces[k]);
      const ElementFace& behind = faces[k + (swap ? 1 : 0)];
      const std::vector<int> ids =
          nodes_of_face(mesh, behind.element, behind.off);
      mesh.faces.insert(mesh.faces.end(), ids.begin(), ids.end());
      mesh.face_label.push_back(0);
      mesh.face_element.push_back(behind.element);
      mesh.face_front.push_back(
          end - k == 1 ? -1 : faces[k + (swap ? 0 : 1)].element);
    }
    k = end;
  }
}

void label_deck_faces(const DeckCards& cards, const FrozenModel& frozen,
                      TetMesh& mesh) {
  const std::vector<int> surface = surfaces_of_faces(
      cards, frozen, static_cast<std::size_t>(mesh.element_count()));
  for (const std::string& name : frozen.model.surface_names) {
    if (mesh.labels.size() < kMostLabels) {
      mesh.labels.push_back(free_name(shown_field(name), mesh.labels));
    }
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto at = static_cast<std::size_t>(f);
    mesh.face_label[at] =
        surface[4 * static_cast<std::size_t>(mesh.face_element[at]) +
                static_cast<std::size_t>(corner_off(mesh, f))];
  }
  NodeSetLabels(cards, frozen, mesh).add();
  const int outside = static_cast<int>(mesh.labels.size());
  mesh.labels.push_back(free_name("outside", mesh.labels));
  const int inside = outside + 1;
  if (std::any_of(mesh.face_front.begin(), mesh.face_front.end(),
                  [](int front) { return front >= 0; })) {
    mesh.labels.push_back(free_name("inside", mesh.labels));
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    int& label = mesh.face_label[static_cast<std::size_t>(f)];
    if (label < 0) {
      label =
          mesh.face_front[static_cast<std::size_t>(f)] < 0 ? outside : inside;
    }
  }
}

}  // namespace meniscus::deck
