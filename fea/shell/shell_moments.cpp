#include "fea/shell/shell_moments.h"

#include "core/parallel_for.h"
#include "fea/shell/taped_facet.h"

namespace meniscus::shell {

namespace {

/// visit(density times weight, place) at all points of a facet's wall.
template <class T, class ThicknessAt, class Visit>
void for_each_mass(const Facet& facet, const std::array<Triple<T>, kNodes>& X,
                   const ThicknessAt& thickness_there, const Visit& visit) {
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<T> frame = facet_frame(X, p, facet.direction);
    const T thickness = thickness_there(p);
    Triple<T> x{};
    for (int i = 0; i < kNodes; ++i) {
      x = plus(x, p.shape[i], X[i]);
    }
    for (const LayerPoint& layer : facet.law->points) {
      const T zeta = (layer.at + facet.offset) * thickness;
      const T weight = p.weight * layer.weight *
                       facet.law->plies[layer.ply].density * frame.area *
                       thickness * determinant(shifter(frame.curvature, zeta));
      visit(weight, plus(x, zeta, frame.axes[2]));
    }
  }
}

MassMoments facet_moments(const Facet& facet, const Vec3& from) {
  MassMoments sum;
  for_each_mass(
      facet, triples(facet),
      [&](const FacetPoint& p) { return thickness_at(facet, p); },
      [&](double mass, const Triple<double>& place) {
        const Vec3 r = as_vector(place) - from;
        sum.mass += mass;
        sum.first += mass * r;
        sum.second += mass * r * r.transpose();
      });
  return sum;
}

Taped value_of(const MassForm& form, const Triple<Taped>& r) {
  Taped sum(form.constant);
  for (int i = 0; i < 3; ++i) {
    Taped row(form.linear[i]);
    for (int j = 0; j < 3; ++j) {
      row = row + form.square(i, j) * r[j];
    }
    sum = sum + r[i] * row;
  }
  return sum;
}

}  // namespace

MassMoments mass_moments(const ShellMesh& mesh,
                         const std::vector<Section>& sections,
                         const Vec3& from) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  std::vector<MassMoments> parts(mesh.facets.size());
  parallel_for(static_cast<std::ptrdiff_t>(parts.size()),
               [&](std::ptrdiff_t k) {
                 parts[k] = facet_moments(
                     facet_of(mesh, sections, laws, static_cast<int>(k)), from);
               });
  MassMoments sum;
  for (const MassMoments& part : parts) {
    sum.mass += part.mass;
    sum.first += part.first;
    sum.second += part.second;
  }
  return sum;
}

ShellGradient mass_integral(const ShellMesh& mesh,
                            const std::vector<Section>& sections,
                            const MassForm& form, const Vec3& from) {
  check_shell(mesh, sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  std::vector<FacetGradient> parts(mesh.facets.size());
  parallel_for(
      static_cast<std::ptrdiff_t>(parts.size()), [&](std::ptrdiff_t k) {
        static thread_local Tape tape;
        const Facet facet = facet_of(mesh, sections, laws, static_cast<int>(k));
        const TapedFacet taped(facet, tape);
        Taped sum(0.0);
        for_each_mass(
            facet, taped.X,
            [&](const FacetPoint& p) { return taped.thickness_at(p); },
            [&](const Taped& mass, const Triple<Taped>& place) {
              const Triple<Taped> r = {place[0] - from[0], place[1] - from[1],
                                       place[2] - from[2]};
              sum = sum + mass * value_of(form, r);
            });
        parts[k] = {sum.value, taped.transpose(sum)};
      });
  return gradient_of(mesh, parts);
}

}  // namespace meniscus::shell
