#include "io/three_mf.h"

#include <array>
#include <cstdint>
#include <map>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/body_surfaces.h"

namespace meniscus::io {

namespace {

constexpr double kLargest = 1 << 30;  // lib3mf takes a little more

DWORD unit_of(const std::string& name, const std::filesystem::path& path) {
  static const std::map<std::string, DWORD> units = {
      {"mm", NMR::MODELUNIT_MILLIMETER},
      {"m", NMR::MODELUNIT_METER},
      {"in", NMR::MODELUNIT_INCH}};
  const auto found = units.find(name);
  if (found == units.end()) {
    throw InvalidInput(
        fmt::format("cannot write '{}': 3MF has no unit '{}'; lengths may be "
                    "in mm, m or in",
                    path.string(), name));
  }
  return found->second;
}

/// One of lib3mf's objects, released with its owner.
class Handle {
 public:
  Handle() = default;
  ~Handle() {
    if (raw_ != nullptr) {
      NMR::lib3mf_release(raw_);
    }
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  NMR::PLib3MFBase** fill() { return &raw_; }
  NMR::PLib3MFBase* get() const { return raw_; }

 private:
  NMR::PLib3MFBase* raw_ = nullptr;
};

class ThreeMfWriter {
 public:
  ThreeMfWriter(const SurfaceMesh& mesh, const ThreeMfOptions& options,
                const std::filesystem::path& path)
      : mesh_(mesh), options_(options), path_(path) {}

  std::string bytes() {
    check(NMR::lib3mf_createmodel(model_.fill()), model_);
    check(NMR::lib3mf_model_setunit(model_.get(),
                                    unit_of(options_.notes.unit, path_)),
          model_);
    metadata();
    const std::vector<BodyFacets> bodies = facets_by_body(mesh_);
    std::vector<Handle> objects(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      add_body(bodies[b], one_line(body_name(options_.bodies, b)), objects[b]);
    }
    if (objects.size() == 1) {
      place(objects[0]);
    } else {
      place_together(objects);
    }
    check(NMR::lib3mf_model_setbuilduuidutf8(model_.get(), uuid().c_str()),
          model_);
    return written();
  }

 private:
  void check(LIB3MFRESULT result, const Handle& at) const {
    if (result == 0) {
      return;
    }
    DWORD code = 0;
    const char* message = nullptr;
    if (at.get() != nullptr) {
      NMR::lib3mf_getlasterror(at.get(), &code, &message);
    }
    throw InvalidInput(fmt::format("cannot write '{}': lib3mf: {} ({:#x})",
                                   path_.string(),
                                   message != nullptr ? message : "failed",
                                   static_cast<std::uint32_t>(result)));
  }

  void metadata() {
    const auto add = [&](const char* key, const std::string& value) {
      if (!value.empty()) {
        check(NMR::lib3mf_model_addmetadatautf8(model_.get(), key,
                                                one_line(value).c_str()),
              model_);
      }
    };
    add("Title", options_.notes.title);
    add("Application", options_.notes.program);
    add("Description",
        fmt::format("{}", fmt::join(options_.notes.lines, "; ")));
  }

  void name(const Handle& object, const std::string& name) {
    check(NMR::lib3mf_object_setnameutf8(object.get(), name.c_str()), object);
    check(NMR::lib3mf_object_setuuidutf8(object.get(), uuid().c_str()), object);
  }

  /// As components of one object, since they belong together.
  void place_together(const std::vector<Handle>& objects) {
    Handle part;
    check(NMR::lib3mf_model_addcomponentsobject(model_.get(), part.fill()),
          model_);
    name(part, one_line(options_.notes.title));
    for (const Handle& object : objects) {
      Handle component;
      check(NMR::lib3mf_componentsobject_addcomponent(
                part.get(), object.get(), nullptr, component.fill()),
            part);
      check(NMR::lib3mf_component_setuuidutf8(component.get(), uuid().c_str()),
            component);
    }
    place(part);
  }

  /// On the build plate, as it stands.
  void place(const Handle& object) {
    Handle item;
    check(NMR::lib3mf_model_addbuilditem(model_.get(), object.get(), nullptr,
                                         item.fill()),
          model_);
    check(NMR::lib3mf_builditem_setuuidutf8(item.get(), uuid().c_str()), item);
  }

  void add_body(const BodyFacets& body, const std::string& body_name,
                Handle& object) {
    std::vector<NMR::MODELMESHVERTEX> vertices;
    std::vector<NMR::MODELMESHTRIANGLE> triangles;
    std::map<int, DWORD> number;
    for (const BodyFacets::Group& group : body.groups) {
      for (const Triangle& facet : group.facets) {
        NMR::MODELMESHTRIANGLE& triangle = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          const auto [at, is_new] =
              number.emplace(facet[k], static_cast<DWORD>(vertices.size()));
          if (is_new) {
            const auto p = static_cast<std::size_t>(facet[k]);
            NMR::MODELMESHVERTEX& vertex = vertices.emplace_back();
            for (int i = 0; i < 3; ++i) {
              vertex.m_fPosition[i] = static_cast<float>(mesh_.points[p][i]);
            }
          }
          triangle.m_nIndices[k] = at->second;
        }
      }
    }
    check(NMR::lib3mf_model_addmeshobject(model_.get(), object.fill()), model_);
    name(object, body_name);
    check(
        NMR::lib3mf_meshobject_setgeometry(
            object.get(), vertices.data(), static_cast<DWORD>(vertices.size()),
            triangles.data(), static_cast<DWORD>(triangles.size())),
        object);
  }

  std::string written() const {
    Handle writer;
    check(NMR::lib3mf_model_querywriter(model_.get(), "3mf", writer.fill()),
          model_);
    ULONG64 size = 0;
    check(NMR::lib3mf_writer_getstreamsize(writer.get(), &size), writer);
    std::string bytes(size, '\0');
    check(NMR::lib3mf_writer_writetobuffer(
              writer.get(), reinterpret_cast<BYTE*>(bytes.data()), size),
          writer);
    return bytes;
  }

  /// lib3mf would draw random ones: these only have to differ in the file.
  std::string uuid() {
    return fmt::format("6d656e69-7363-4573-8000-{:012x}", ++uuids_);
  }

  const SurfaceMesh& mesh_;
  const ThreeMfOptions& options_;
  const std::filesystem::path& path_;
  Handle model_;
  std::uint64_t uuids_ = 0;
};

}  // namespace

void write_3mf(const std::filesystem::path& path, const SurfaceMesh& mesh,
               const ThreeMfOptions& options) {
  check_for_file(mesh, path, kLargest);
  write_file(path, ThreeMfWriter(mesh, options, path).bytes());
}

}  // namespace meniscus::io
