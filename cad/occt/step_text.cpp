#include "cad/occt/step_text.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "cad/occt/step_session.h"
#include "cad/occt/step_shape.h"
#include "core/error.h"

namespace meniscus::occt {

namespace {

// Of the integral over a face: the plain rule is a percent off in planes that
// are B-splines.
constexpr double kVolumeError = 1e-7;
constexpr double kReadVolumeError = 1e-4;  // the same, when it is read again
constexpr double kSameVolume = 3e-3;  // what readers may change [of the volume]

/// What BRepCheck_Analyzer finds first; empty for a valid shape.
std::string fault_of(const StepShape& shape) {
  const BRepCheck_Analyzer check(shape.solid);
  if (check.IsValid()) {
    return {};
  }
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    if (check.IsValid(shape.faces[f])) {
      continue;
    }
    std::string statuses;
    for (const TopAbs_ShapeEnum kind :
         {TopAbs_FACE, TopAbs_WIRE, TopAbs_EDGE, TopAbs_VERTEX}) {
      for (TopExp_Explorer at(shape.faces[f], kind); at.More(); at.Next()) {
        const auto& found = check.Result(at.Current());
        for (found->InitContextIterator(); found->MoreShapeInContext();
             found->NextShapeInContext()) {
          for (const BRepCheck_Status status : found->StatusOnShape()) {
            if (status != BRepCheck_NoError) {
              statuses += fmt::format(" {}:{}", static_cast<int>(kind),
                                      static_cast<int>(status));
            }
          }
        }
        for (const BRepCheck_Status status : found->Status()) {
          if (status != BRepCheck_NoError) {
            statuses += fmt::format(" {}:{}", static_cast<int>(kind),
                                    static_cast<int>(status));
          }
        }
      }
    }
    return fmt::format("face {} '{}' (BRepCheck{})", f, shape.names[f],
                       statuses);
  }
  return "its shells";
}

void set_header(STEPCAFControl_Writer& writer, const std::string& name) {
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  const auto text = [](const char* words) {
    return new TCollection_HAsciiString(words);
  };
  header.SetName(text(name.c_str()));
  header.SetTimeStamp(text("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text(""));
  header.SetOrganizationValue(1, text(""));
  header.SetOriginatingSystem(text("Meniscus"));
  header.SetPreprocessorVersion(text("Open CASCADE Technology"));
  header.SetAuthorisation(text(""));
}

std::string ascii(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c >= ' ' && c <= '~' ? c : '_';
  }
  return result;
}

/// Other programs read the file and not the shape: throws MeshError unless it
/// comes back with as many faces, valid, and of the same volume.
void check_by_reading(const std::string& text, std::size_t written,
                      double volume) {
  STEPControl_Reader reader;
  std::istringstream file(text);
  const bool found = reader.ReadStream("part.step", file) == IFSelect_RetDone &&
                     reader.TransferRoots() > 0;
  std::size_t faces = 0;
  GProp_GProps properties;
  bool valid = false;
  if (found) {
    const TopoDS_Shape back = reader.OneShape();
    for (TopExp_Explorer at(back, TopAbs_FACE); at.More(); at.Next()) {
      ++faces;
    }
    valid = BRepCheck_Analyzer(back).IsValid();
    BRepGProp::VolumeProperties(back, properties, kReadVolumeError);
  }
  if (!valid || faces != written ||
      std::abs(properties.Mass() - volume) > kSameVolume * std::abs(volume)) {
    throw MeshError(fmt::format(
        "read again, the file is {} solid of {} faces and {:.6g} mm3 where {} "
        "faces of {:.6g} mm3 were written; export it as step-faceted, or "
        "settle it with another --edge",
        valid ? "a" : "no valid", faces, properties.Mass(), written, volume));
  }
}

/// A solid that was found valid, and what it encloses.
struct CheckedPart {
  std::string name;
  StepShape shape;
  GProp_GProps properties;
};

CheckedPart checked(const step::StepPart& part, double millimetres) {
  CheckedPart result{part.name, step_shape(part.brep, millimetres), {}};
  const std::string fault = fault_of(result.shape);
  if (!fault.empty()) {
    throw MeshError(fmt::format("the faces make no valid solid: {}", fault));
  }
  BRepGProp::VolumeProperties(result.shape.solid, result.properties,
                              kVolumeError);
  return result;
}

step::StepReport report_of(const std::vector<CheckedPart>& parts,
                           double millimetres) {
  step::StepReport report;
  GProp_GProps all;
  for (const CheckedPart& part : parts) {
    report.shells += part.shape.shells;
    all.Add(part.properties);
    ShapeAnalysis_ShapeTolerance tolerances;
    report.tolerance =
        std::max(report.tolerance,
                 tolerances.Tolerance(part.shape.solid, 1) / millimetres);
  }
  report.volume = all.Mass() / std::pow(millimetres, 3);
  const gp_Pnt center = all.CentreOfMass();
  report.mass_center = Vec3(center.X(), center.Y(), center.Z()) / millimetres;
  return report;
}

/// The solid and its faces with their names.
void add_part(const Handle(TDocStd_Document) & document, const StepShape& shape,
              const std::string& name) {
  const Handle(XCAFDoc_ShapeTool) tool =
      XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label part = tool->AddShape(shape.solid, Standard_False);
  TDataStd_Name::Set(part, name.c_str());
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const TDF_Label label = tool->AddSubShape(part, shape.faces[f]);
    if (!label.IsNull()) {
      TDataStd_Name::Set(label, ascii(shape.names[f]).c_str());
    }
  }
}

std::string file_text(const std::filesystem::path& path,
                      const std::vector<CheckedPart>& parts,
                      const std::string& name, const StepUnit& unit) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  for (const CheckedPart& part : parts) {
    add_part(document, part.shape, ascii(part.name));
  }
  STEPCAFControl_Controller::Init();  // before its settings, and they before
                                      // use
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", unit.name);
  Interface_Static::SetCVal("write.step.product.name", name.c_str());
  Interface_Static::SetIVal("write.precision.mode", 1);  // the greatest
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  STEPCAFControl_Writer writer;
  writer.SetColorMode(false);
  writer.SetLayerMode(false);
  writer.SetNameMode(true);
  if (!writer.Transfer(document, STEPControl_AsIs)) {
    throw IoError(
        fmt::format("{}: the solid cannot be put into STEP", path.string()));
  }
  set_header(writer, name);
  const Handle(StepData_Protocol) protocol = Handle(
      StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol());
  StepData_StepWriter text_writer(writer.ChangeWriter().Model());
  text_writer.SendModel(protocol);
  std::ostringstream text;
  text_writer.Print(text);
  XCAFApp_Application::GetApplication()->Close(document);
  return text.str();
}

StepText checked_text(const std::filesystem::path& path,
                      const std::vector<step::StepPart>& parts,
                      const step::StepOptions& options) {
  const StepUnit unit = step_unit(options.unit);
  const StepSilence silence;
  std::vector<CheckedPart> shapes;
  std::size_t faces = 0;
  double volume = 0.0;
  for (const step::StepPart& part : parts) {
    shapes.push_back(checked(part, unit.millimetres));
    faces += shapes.back().shape.faces.size();
    volume += shapes.back().properties.Mass();
  }
  StepText result{file_text(path, shapes, ascii(options.name), unit),
                  report_of(shapes, unit.millimetres)};
  check_by_reading(result.text, faces, volume);
  return result;
}

}  // namespace

StepText step_text(const std::filesystem::path& path,
                   const std::vector<step::StepPart>& parts,
                   const step::StepOptions& options) {
  try {
    return checked_text(path, parts, options);
  } catch (const Standard_Failure& failure) {
    throw MeshError(fmt::format("OpenCASCADE makes no solid of the faces: {}",
                                failure.DynamicType()->Name()));
  }
}

}  // namespace meniscus::occt
