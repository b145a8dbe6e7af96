#include "pipeline/whole/whole_part.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "fea/element/region_nodes.h"
#include "fea/shell/shell_stress.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/shells/shell_part.h"

namespace meniscus::whole {

namespace {

// Corners 0 and 1 of an image change places, so that its volume is above 0 and
// its faces look out: where nodes of the image are in what is drawn.
constexpr std::array<int, 10> kElementImage = {1, 0, 2, 3, 4, 6, 5, 8, 7, 9};
constexpr std::array<int, 6> kFaceImage = {1, 0, 2, 3, 5, 4};
constexpr std::array<std::size_t, 4> kPointImage = {1, 0, 2, 3};

/// In one plane.
class Mirror {
 public:
  Mirror(const case_data::Case& input, std::size_t plane)
      : plane_(input.symmetry[plane]),
        turn_(Mat3::Identity() -
              2.0 * plane_.normal * plane_.normal.transpose()),
        cut_(case_data::cuts_of_whole(input, plane)) {}

  bool cuts(const std::string& label) const {
    return std::find(cut_.begin(), cut_.end(), label) != cut_.end();
  }

  Vec3 point(const Vec3& p) const {
    return p - 2.0 * case_data::beyond(plane_, p) * plane_.normal;
  }
  Vec3 vector(const Vec3& v) const { return turn_ * v; }

  element::Stress stress(const element::Stress& s) const {
    Mat3 full;
    full << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Mat3 image = turn_ * full * turn_;
    return {image(0, 0), image(1, 1), image(2, 2),
            image(0, 1), image(1, 2), image(2, 0)};
  }

 private:
  case_data::SymmetryPlane plane_;
  Mat3 turn_;
  std::vector<std::string> cut_;
};

/// Numbers of labels of images, which are made where they are not there yet.
std::vector<int> image_labels(std::vector<std::string>& labels) {
  std::vector<int> result;
  const std::vector<std::string> drawn = labels;
  for (const std::string& label : drawn) {
    const std::string image = case_data::image_name(label);
    const auto at = std::find(labels.begin(), labels.end(), image);
    result.push_back(static_cast<int>(at - labels.begin()));
    if (at == labels.end()) {
      labels.push_back(image);
    }
  }
  return result;
}

SurfaceMesh with_image(const SurfaceMesh& drawn, const Mirror& mirror) {
  SurfaceMesh whole = drawn;
  whole.facets.clear();
  whole.facet_label.clear();
  whole.facet_bodies.clear();
  std::vector<char> shared(drawn.points.size(), 0);
  const auto is_cut = [&](std::size_t f) {
    return mirror.cuts(drawn.labels[drawn.facet_label[f]]);
  };
  for (std::size_t f = 0; f < drawn.facets.size(); ++f) {
    for (const int v : drawn.facets[f]) {
      shared[v] = shared[v] != 0 || is_cut(f) ? 1 : 0;
    }
  }
  std::vector<int> image(drawn.points.size());
  for (std::size_t v = 0; v < image.size(); ++v) {
    image[v] = static_cast<int>(v);
    if (shared[v] == 0) {
      image[v] = static_cast<int>(whole.points.size());
      whole.points.push_back(mirror.point(drawn.points[v]));
    }
  }
  const std::vector<int> label_image = image_labels(whole.labels);
  for (const bool is_image : {false, true}) {
    for (std::size_t f = 0; f < drawn.facets.size(); ++f) {
      if (is_cut(f)) {
        continue;
      }
      const auto [a, b, c] = drawn.facets[f];
      const int label = drawn.facet_label[f];
      whole.facets.push_back(is_image ? Triangle{image[b], image[a], image[c]}
                                      : Triangle{a, b, c});
      whole.facet_label.push_back(is_image ? label_image[label] : label);
      if (!drawn.facet_bodies.empty()) {
        whole.facet_bodies.push_back(drawn.facet_bodies[f]);
      }
    }
  }
  return whole;
}

/// Where the nodes of what is drawn, and of its image, are in the whole:
/// corners of both come first.
struct NodeImages {
  std::vector<int> drawn, image;
  int count = 0;
  int corners = 0;
};

/// One char per node: 1 in the plane.
std::vector<char> shared_nodes(const forward::EvaluationFields& fields,
                               const Mirror& mirror) {
  const TetMesh& mesh = fields.mesh;
  std::vector<char> shared(mesh.nodes.size(), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mirror.cuts(mesh.labels[mesh.face_label[f]])) {
      for (const int n : mesh.face(f)) {
        shared[n] = 1;
      }
    }
  }
  if (fields.shell) {
    for (const auto& [name, line] : fields.shell->rims) {
      for (const auto& edge : line) {
        for (const int n : edge) {
          shared[n] = shared[n] != 0 || mirror.cuts(name) ? 1 : 0;
        }
      }
    }
  }
  return shared;
}

NodeImages node_images(const TetMesh& mesh, const std::vector<char>& shared) {
  NodeImages result{std::vector<int>(mesh.nodes.size()),
                    std::vector<int>(mesh.nodes.size())};
  const auto add = [&](int begin, int end) {
    for (int n = begin; n < end; ++n) {
      result.drawn[n] = result.count++;
    }
    for (int n = begin; n < end; ++n) {
      result.image[n] = shared[n] != 0 ? result.drawn[n] : result.count++;
    }
  };
  add(0, mesh.corner_count);
  result.corners = result.count;
  add(mesh.corner_count, static_cast<int>(mesh.nodes.size()));
  return result;
}

void add_faces(const TetMesh& drawn, const NodeImages& at, const Mirror& mirror,
               TetMesh& whole) {
  const std::vector<int> label_image = image_labels(whole.labels);
  for (const bool is_image : {false, true}) {
    const int shift = is_image ? drawn.element_count() : 0;
    for (int f = 0; f < drawn.face_count(); ++f) {
      if (mirror.cuts(drawn.labels[drawn.face_label[f]])) {
        continue;
      }
      const std::span<const int> nodes = drawn.face(f);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        whole.faces.push_back(is_image ? at.image[nodes[kFaceImage[k]]]
                                       : at.drawn[nodes[k]]);
      }
      const int label = drawn.face_label[f];
      whole.face_label.push_back(is_image ? label_image[label] : label);
      if (!drawn.face_element.empty()) {
        whole.face_element.push_back(drawn.face_element[f] + shift);
      }
      if (!drawn.face_front.empty()) {
        const int front = drawn.face_front[f];
        whole.face_front.push_back(front < 0 ? front : front + shift);
      }
    }
  }
}

TetMesh with_image(const TetMesh& drawn, const NodeImages& at,
                   const Mirror& mirror) {
  TetMesh whole;
  whole.order = drawn.order;
  whole.labels = drawn.labels;
  whole.corner_count = at.corners;
  whole.nodes.resize(static_cast<std::size_t>(at.count));
  for (std::size_t n = 0; n < drawn.nodes.size(); ++n) {
    whole.nodes[at.image[n]] = mirror.point(drawn.nodes[n]);
    whole.nodes[at.drawn[n]] = drawn.nodes[n];  // of shared ones the last word
  }
  for (const bool is_image : {false, true}) {
    for (int e = 0; e < drawn.element_count(); ++e) {
      const std::span<const int> nodes = drawn.element(e);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        whole.elements.push_back(is_image ? at.image[nodes[kElementImage[k]]]
                                          : at.drawn[nodes[k]]);
      }
    }
    whole.element_region.insert(whole.element_region.end(),
                                drawn.element_region.begin(),
                                drawn.element_region.end());
  }
  add_faces(drawn, at, mirror, whole);
  return whole;
}

/// Three numbers per node; of `forces` those in the plane are of both sides,
/// which cancel across it.
VectorX with_image(const VectorX& drawn, const NodeImages& at,
                   const Mirror& mirror, bool forces) {
  if (drawn.size() == 0) {
    return drawn;
  }
  VectorX whole = VectorX::Zero(3 * at.count);
  for (std::size_t n = 0; n < at.drawn.size(); ++n) {
    const Vec3 here = drawn.segment<3>(static_cast<Eigen::Index>(3 * n));
    whole.segment<3>(3 * at.drawn[n]) = here;
    if (at.image[n] != at.drawn[n]) {
      whole.segment<3>(3 * at.image[n]) = mirror.vector(here);
    } else if (forces) {
      whole.segment<3>(3 * at.image[n]) += mirror.vector(here);
    }
  }
  return whole;
}

template <class Item>
std::vector<Item> twice(std::vector<Item> items) {
  items.reserve(2 * items.size());
  const std::size_t count = items.size();
  for (std::size_t k = 0; k < count; ++k) {
    items.push_back(items[k]);
  }
  return items;
}

element::PointStress with_image(const element::PointStress& drawn,
                                const Mirror& mirror) {
  element::PointStress whole = drawn;
  const auto per = static_cast<std::size_t>(drawn.points_per_element);
  for (std::size_t k = 0; k < drawn.stress.size(); ++k) {
    const std::size_t from = per == 1 ? k : k - k % per + kPointImage[k % per];
    whole.stress.push_back(mirror.stress(drawn.stress[from]));
    whole.position.push_back(mirror.point(drawn.position[from]));
    whole.volume.push_back(drawn.volume[from]);
  }
  return whole;
}

element::Stress mean(const element::Stress& a, const element::Stress& b) {
  element::Stress result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = 0.5 * (a[k] + b[k]);
  }
  return result;
}

/// At nodes in the plane the mean of both sides, whose shear across the plane
/// cancels: recovery knew one side alone.
stress::RecoveredStress with_image(const stress::RecoveredStress& drawn,
                                   const TetMesh& whole, const Mirror& mirror) {
  stress::RecoveredStress result{.nodes = element::region_nodes(whole),
                                 .value = {}};
  const auto count = static_cast<std::size_t>(result.nodes.count());
  result.value.resize(count);
  std::vector<char> is_drawn(count, 0);
  const int elements = whole.element_count() / 2;
  for (int e = 0; e < elements; ++e) {
    const std::span<const int> from = drawn.nodes.element(e);
    const std::span<const int> to = result.nodes.element(e);
    for (std::size_t k = 0; k < from.size(); ++k) {
      result.value[to[k]] = drawn.value[from[k]];
      is_drawn[to[k]] = 1;
    }
  }
  for (int e = 0; e < elements; ++e) {
    const std::span<const int> from = drawn.nodes.element(e);
    const std::span<const int> to = result.nodes.element(e + elements);
    for (std::size_t k = 0; k < to.size(); ++k) {
      const element::Stress& here = drawn.value[from[kElementImage[k]]];
      const element::Stress image = mirror.stress(here);
      result.value[to[k]] = is_drawn[to[k]] != 0 ? mean(here, image) : image;
    }
  }
  return result;
}

shell::FacetStress with_image(const shell::FacetStress& drawn,
                              const Mirror& mirror) {
  shell::FacetStress image;
  for (std::size_t k = 0; k < image.size(); ++k) {
    const shell::WallStress& from = drawn[kFaceImage[k]];
    image[k] = {mirror.stress(from.negative), mirror.stress(from.middle),
                mirror.stress(from.positive)};
  }
  return image;
}

/// Displacements turn over as vectors do, rotations the other way.
VectorX six_with_image(const VectorX& drawn, const NodeImages& at,
                       const Mirror& mirror) {
  VectorX whole(6L * at.count);
  for (std::size_t n = 0; n < at.drawn.size(); ++n) {
    const auto own = drawn.segment<6>(static_cast<Eigen::Index>(6 * n));
    whole.segment<6>(6L * at.image[n]) << mirror.vector(own.head<3>()),
        -mirror.vector(own.tail<3>());
    whole.segment<6>(6L * at.drawn[n]) = own;
  }
  return whole;
}

/// A shell that is shown, not solved. `skin`: of the whole.
std::shared_ptr<shells::ShellPart> with_image(const shells::ShellPart& drawn,
                                              const TetMesh& skin,
                                              const NodeImages& at,
                                              const Mirror& mirror) {
  auto whole = std::make_shared<shells::ShellPart>();
  whole->skin = skin;
  whole->mesh.nodes = skin.nodes;
  whole->mesh.section = twice(drawn.mesh.section);
  whole->mesh.thickness = twice(drawn.mesh.thickness);
  for (std::size_t f = 0; f < drawn.mesh.facets.size(); ++f) {
    Vec3& t = whole->mesh.thickness[drawn.mesh.facets.size() + f];
    std::swap(t[0], t[1]);
  }
  for (int f = 0; f < skin.face_count(); ++f) {
    const std::span<const int> nodes = skin.face(f);
    std::copy(nodes.begin(), nodes.end(),
              whole->mesh.facets.emplace_back().begin());
  }
  whole->sections = drawn.sections;
  for (const auto& [name, line] : drawn.rims) {
    shell::Line& both = whole->rims[name];
    for (const auto& [from, to, middle] : line) {
      both.push_back({at.drawn[from], at.drawn[to], at.drawn[middle]});
      both.push_back({at.image[from], at.image[to], at.image[middle]});
    }
  }
  for (const shells::ShellCase& own : drawn.cases) {
    shells::ShellCase& both = whole->cases.emplace_back();
    both.displacement = six_with_image(own.displacement, at, mirror);
    both.stress = own.stress;
    for (const shell::FacetStress& stress : own.stress) {
      both.stress.push_back(with_image(stress, mirror));
    }
  }
  return whole;
}

/// What files and pictures show; temperatures, and sums of errors, stay those
/// of the drawn part.
void mirror_fields(const Mirror& mirror, forward::EvaluationFields& fields) {
  fields.film = with_image(fields.film, mirror);
  fields.boundary = with_image(fields.boundary, mirror);
  const NodeImages at = node_images(fields.mesh, shared_nodes(fields, mirror));
  const TetMesh whole = with_image(fields.mesh, at, mirror);
  for (VectorX& u : fields.solution.displacements) {
    u = with_image(u, at, mirror, false);
  }
  for (VectorX& forces : fields.solution.reactions) {
    forces = with_image(forces, at, mirror, true);
  }
  for (forward::ModeShape& mode : fields.modes) {
    mode.shape = with_image(mode.shape, at, mirror, false);
  }
  if (fields.shell) {
    fields.shell = with_image(*fields.shell, whole, at, mirror);
  }
  for (forward::PartStress& stress : fields.stresses) {
    stress.points = with_image(stress.points, mirror);
    stress.recovered = with_image(stress.recovered, whole, mirror);
    stress.error.element = twice(std::move(stress.error.element));
  }
  stress::Excluded& out = fields.exclusion.what;
  out.element = twice(std::move(out.element));
  if (!out.node.empty()) {
    std::vector<char> node(whole.nodes.size());
    for (std::size_t n = 0; n < at.drawn.size(); ++n) {
      node[at.drawn[n]] = node[at.image[n]] = out.node[n];
    }
    out.node = std::move(node);
  }
  fields.mesh = whole;
}

}  // namespace

SurfaceMesh whole_surface(const case_data::Case& input, SurfaceMesh drawn) {
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    drawn = with_image(drawn, Mirror(input, p));
  }
  return drawn;
}

std::optional<forward::EvaluationFields> whole_part(
    const case_data::Case& input, const forward::EvaluationFields& drawn) {
  if (input.symmetry.empty() || drawn.mesh.nodes.empty()) {
    return std::nullopt;
  }
  forward::EvaluationFields whole = drawn;
  for (std::size_t p = 0; p < input.symmetry.size(); ++p) {
    mirror_fields(Mirror(input, p), whole);
  }
  return whole;
}

}  // namespace meniscus::whole
