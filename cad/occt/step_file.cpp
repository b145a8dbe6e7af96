#include "cad/occt/step_file.h"

#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "cad/occt/step_session.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace meniscus::occt {

std::string StepFile::name_of(const TopoDS_Shape& part) const {
  const auto item = Handle(StepRepr_RepresentationItem)::DownCast(
      reader.WS()->TransferReader()->EntityFromShapeResult(part, 1));
  return item.IsNull() || item->Name().IsNull() ? ""
                                                : item->Name()->ToCString();
}

void open_step(StepFile& file, const std::filesystem::path& path,
               const std::string& unit) {
  const StepUnit wanted = step_unit(unit);
  // OpenCASCADE does not say why it cannot; this does.
  if (read_file(path).substr(0, 13) != "ISO-10303-21;") {
    throw InvalidInput(fmt::format(
        "{}:1: found no 'ISO-10303-21;'; expected a STEP file", path.string()));
  }
  file.path = path;
  file.millimetres = wanted.millimetres;
  if (file.reader.ReadFile(path.c_str()) != IFSelect_RetDone ||
      file.reader.TransferRoots() == 0) {
    throw InvalidInput(
        fmt::format("{}: OpenCASCADE finds no shape in it; is the file whole?",
                    path.string()));
  }
  file.shape = file.reader.OneShape();
}

}  // namespace meniscus::occt
