#include "io/deck/deck_mesh.h"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/outlier.h"

namespace meniscus::deck {

namespace {

/// The deck's nodes by their part in elements.
enum class NodeUse : char { None, Corner, MidSide };

class MeshFreezer {
 public:
  MeshFreezer(const DeckCards& cards, FrozenModel& frozen, ReadDeck& deck)
      : cards_(cards), model_(frozen.model), frozen_(frozen), deck_(deck) {}

  void freeze() {
    check_numbers();
    find_uses();
    number_nodes();
    fill_elements();
    check_mid_sides();
    regions();
  }

 private:
  void check_numbers() {
    if (model_.elements.empty()) {
      cards_.refuse(DeckPlace{0, 1},
                    "the deck has no elements before its first *STEP; expected "
                    "*NODE and *ELEMENT, TYPE=C3D4 or C3D10");
    }
    if (const int twice = model_.node_numbers.sort(); twice >= 0) {
      cards_.refuse(model_.node_places[static_cast<std::size_t>(twice)],
                    fmt::format("node {} is there already",
                                model_.node_numbers.number(twice)));
    }
    if (const int twice = model_.element_numbers.sort(); twice >= 0) {
      cards_.refuse(model_.elements[static_cast<std::size_t>(twice)].at,
                    fmt::format("element {} is there already",
                                model_.element_numbers.number(twice)));
    }
  }

  int corners_and_mids() const { return model_.nodes_per_element; }

  void find_uses() {
    uses_.assign(model_.nodes.size(), NodeUse::None);
    places_.reserve(model_.elements.size() *
                    static_cast<std::size_t>(corners_and_mids()));
    for (std::size_t e = 0; e < model_.elements.size(); ++e) {
      const RawElement& element = model_.elements[e];
      const auto begin = static_cast<std::ptrdiff_t>(places_.size());
      for (int a = 0; a < corners_and_mids(); ++a) {
        const int number = element.nodes[static_cast<std::size_t>(a)];
        const int place = model_.node_numbers.place_of(number);
        if (place < 0) {
          refuse_element(
              e, fmt::format("names node {}, which the deck has not", number));
        }
        if (std::find(places_.begin() + begin, places_.end(), place) !=
            places_.end()) {
          refuse_element(e, fmt::format("names node {} twice", number));
        }
        places_.push_back(place);
        NodeUse& use = uses_[static_cast<std::size_t>(place)];
        const NodeUse now = a < 4 ? NodeUse::Corner : NodeUse::MidSide;
        if (use != NodeUse::None && use != now) {
          refuse_element(e, fmt::format("has node {} as a {}, another element "
                                        "as the other; are the nodes in order?",
                                        number, a < 4 ? "corner" : "mid-side"));
        }
        use = now;
      }
    }
  }

  [[noreturn]] void refuse_element(std::size_t e, const std::string& what) {
    cards_.refuse(
        model_.elements[e].at,
        fmt::format("element {} {}",
                    model_.element_numbers.number(static_cast<int>(e)), what));
  }

  /// Corners first, each kind in the order of the file.
  void number_nodes() {
    TetMesh& mesh = deck_.mesh;
    frozen_.node_of.assign(model_.nodes.size(), -1);
    for (const NodeUse use : {NodeUse::Corner, NodeUse::MidSide}) {
      for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
        if (uses_[i] == use) {
          frozen_.node_of[i] = static_cast<int>(mesh.nodes.size());
          mesh.nodes.push_back(model_.nodes[i]);
          deck_.node_numbers.push_back(
              model_.node_numbers.number(static_cast<int>(i)));
        }
      }
      if (use == NodeUse::Corner) {
        mesh.corner_count = static_cast<int>(mesh.nodes.size());
      }
    }
    if (const auto outlier = find_outlier(mesh.nodes)) {
      const int place = model_.node_numbers.place_of(
          deck_.node_numbers[static_cast<std::size_t>(outlier->point)]);
      cards_.refuse(model_.node_places[static_cast<std::size_t>(place)],
                    outlier_text(*outlier, mesh.nodes));
    }
  }

  void fill_elements() {
    TetMesh& mesh = deck_.mesh;
    mesh.order = corners_and_mids() == 4 ? 1 : 2;
    mesh.elements.reserve(places_.size());
    for (const int place : places_) {
      mesh.elements.push_back(frozen_.node_of[static_cast<std::size_t>(place)]);
    }
    deck_.element_files = cards_.files;
    for (std::size_t e = 0; e < model_.elements.size(); ++e) {
      const int id = static_cast<int>(e);
      deck_.element_numbers.push_back(model_.element_numbers.number(id));
      const DeckPlace& at = model_.elements[e].at;
      deck_.element_places.push_back({at.file, at.line});
      frozen_.element_of.push_back(id);
      if (!(corner_volume(mesh, id) > 0.0)) {
        refuse_element(
            e, fmt::format("has a volume of {:.4g}: it is flat or its nodes "
                           "are not in CalculiX's order",
                           corner_volume(mesh, id)));
      }
    }
  }

  /// A mid-side node is between the same two corners in all of its elements:
  /// the solver's mesh of corners hangs on that.
  void check_mid_sides() {
    const TetMesh& mesh = deck_.mesh;
    std::vector<Edge> ends(mesh.nodes.size(), Edge{-1, -1});
    for (int e = 0; mesh.order == 2 && e < mesh.element_count(); ++e) {
      const auto ids = mesh.element(e);
      for (std::size_t m = 0; m < kTetEdges.size(); ++m) {
        const int a = ids[static_cast<std::size_t>(kTetEdges[m][0])];
        const int b = ids[static_cast<std::size_t>(kTetEdges[m][1])];
        const Edge edge = {std::min(a, b), std::max(a, b)};
        const int mid = ids[4 + m];
        Edge& known = ends[static_cast<std::size_t>(mid)];
        if (known[0] >= 0 && known != edge) {
          refuse_element(
              static_cast<std::size_t>(e),
              fmt::format("has node {} between other corners than an element "
                          "before it; are the nodes in CalculiX's order?",
                          deck_.node_numbers[static_cast<std::size_t>(mid)]));
        }
        known = edge;
      }
    }
  }

  /// The last section of an element counts.
  void regions() {
    std::vector<int> section(model_.elements.size(), -1);
    for (std::size_t s = 0; s < model_.sections.size(); ++s) {
      const RawSection& raw = model_.sections[s];
      for (const int e : model_.element_sets.places(cards_, raw.at, raw.elset,
                                                    model_.element_numbers)) {
        section[static_cast<std::size_t>(e)] = static_cast<int>(s);
      }
    }
    std::map<std::pair<std::string, std::string>, int> known;
    std::vector<int> region_of(model_.sections.size(), -1);
    for (std::size_t e = 0; e < section.size(); ++e) {
      if (section[e] < 0) {
        refuse_element(e,
                       "has no *SOLID SECTION; give one that names a set "
                       "with it");
      }
      int& region = region_of[static_cast<std::size_t>(section[e])];
      if (region < 0) {
        const RawSection& raw =
            model_.sections[static_cast<std::size_t>(section[e])];
        const auto [at, is_new] =
            known.try_emplace({raw.material, raw.orientation},
                              static_cast<int>(deck_.materials.size()));
        if (is_new) {
          add_material(raw);
        }
        region = at->second;
      }
      deck_.mesh.element_region.push_back(region);
    }
  }

  void add_material(const RawSection& section) {
    const auto at = model_.materials.find(section.material);
    if (at == model_.materials.end()) {
      cards_.refuse(section.at, fmt::format("the deck has no material '{}'",
                                            shown_field(section.material)));
    }
    const RawMaterial& raw = at->second;
    if (!raw.elastic) {
      cards_.refuse(raw.at, fmt::format("material '{}' has no *ELASTIC",
                                        raw.material.name));
    }
    io::DeckMaterial material = raw.material;
    if (!section.orientation.empty()) {
      const auto axes = model_.orientations.find(section.orientation);
      if (axes == model_.orientations.end()) {
        cards_.refuse(section.at,
                      fmt::format("the deck has no orientation '{}'",
                                  shown_field(section.orientation)));
      }
      if (material.orthotropic) {
        material.orthotropic->axis_1 = axes->second.axis_1;
        material.orthotropic->axis_2 = axes->second.axis_2;
      }
    }
    deck_.materials.push_back(std::move(material));
    deck_.material_places.push_back(cards_.place(raw.at));
  }

  const DeckCards& cards_;
  DeckModel& model_;
  FrozenModel& frozen_;
  ReadDeck& deck_;
  std::vector<NodeUse> uses_;
  std::vector<int> places_;  // of all elements' nodes, in the model
};

}  // namespace

FrozenModel freeze_deck_model(const DeckCards& cards, DeckModel model,
                              ReadDeck& deck) {
  FrozenModel frozen{std::move(model), {}, {}};
  deck.heading = frozen.model.heading;
  deck.not_needed.insert(deck.not_needed.end(), frozen.model.not_needed.begin(),
                         frozen.model.not_needed.end());
  MeshFreezer(cards, frozen, deck).freeze();
  add_deck_faces(cards, deck.element_places, deck.mesh);
  label_deck_faces(cards, frozen, deck.mesh);
  return frozen;
}

std::vector<int> elements_named(const DeckCards& cards,
                                const FrozenModel& frozen, const DeckPlace& at,
                                std::string_view field) {
  return frozen.model.element_sets.places_named(cards, at, field,
                                                frozen.model.element_numbers);
}

}  // namespace meniscus::deck
