#include "evolve/films/rims.h"

#include <algorithm>
#include <tuple>

namespace meniscus::films {

std::vector<int> rim_neighbours(const FilmComplex& complex) {
  const auto& vertices = complex.vertices;
  std::vector<char> marked(complex.curves.size(), 0);
  for (const ComplexEdge& edge : complex.edges) {
    if (edge.curve >= 0 && edge.kind != VertexKind::OnEdge) {
      marked[edge.curve] = 1;
    }
  }
  std::vector<int> order;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].kind == VertexKind::OnCurve &&
        marked[vertices[v].curve] == 0) {
      order.push_back(static_cast<int>(v));
    }
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const ComplexVertex& va = vertices[a];
    const ComplexVertex& vb = vertices[b];
    return std::tie(va.curve, va.t, a) < std::tie(vb.curve, vb.t, b);
  });
  std::vector<int> next(vertices.size(), -1);
  std::size_t first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool last = i + 1 == order.size() ||
                      vertices[order[i + 1]].curve != vertices[order[i]].curve;
    next[order[i]] = last ? order[first] : order[i + 1];
    if (last) {
      first = i + 1;
    }
  }
  return next;
}

}  // namespace meniscus::films
