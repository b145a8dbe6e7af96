/// The mesh of a deck's model, its regions, faces and labels (internal to the
/// deck reader).
#pragma once

#include <vector>

#include "io/deck/deck_model.h"
#include "io/deck/deck_reader.h"

namespace meniscus::deck {

/// The model with its mesh, for the steps.
struct FrozenModel {
  DeckModel model;
  std::vector<int> node_of;     // by the model's place: of the mesh, or -1:
                                // in no element
  std::vector<int> element_of;  // by the model's place: of the mesh
};

/// Fills `deck` but for its steps. Throws InvalidInput for what makes no mesh:
/// numbers that come twice, nodes that are not there or are both corner and
/// mid-side, elements without section or turned inside out, three elements on
/// one face.
FrozenModel freeze_deck_model(const DeckCards& cards, DeckModel model,
                              ReadDeck& deck);

/// Boundary faces, outward, and faces between regions, out of the lower one,
/// as TetMesh has them; all labelled 0. Throws InvalidInput where more than two
/// elements share a face.
void add_deck_faces(const DeckCards& cards,
                    const std::vector<std::array<int, 2>>& element_places,
                    TetMesh& mesh);

/// Nodes of the face of an element that has not the corner `off`, in TetMesh's
/// order.
std::vector<int> nodes_of_face(const TetMesh& mesh, int element, int off);

/// Labels of the faces by the deck's surfaces and node sets (deck_reader.h).
void label_deck_faces(const DeckCards& cards, const FrozenModel& frozen,
                      TetMesh& mesh);

/// The elements, ascending, that "12" or a set names.
std::vector<int> elements_named(const DeckCards& cards,
                                const FrozenModel& frozen, const DeckPlace& at,
                                std::string_view field);

}  // namespace meniscus::deck
