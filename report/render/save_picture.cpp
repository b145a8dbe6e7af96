#include "report/render/save_picture.h"

#include <array>
#include <cstdint>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"

namespace meniscus::render {

namespace {

// Of 0 to 9: a tenth more bytes than 6, in a third of its time.
constexpr int kCompression = 3;

// Where each pixel is looked at: no two in a row or column (a rotated grid),
// so that edges near an axis are as smooth as others. Plain passes cost less
// than the renderer's own multisampling.
constexpr std::array<std::array<double, 2>, 4> kSamples = {
    {{-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}}};

/// One for all pictures of the process: what one has compiled serves the next.
vtkRenderWindow* shared_window() {
  static const vtkNew<vtkRenderWindow> window = [] {
    vtkNew<vtkRenderWindow> made;
    made->SetOffScreenRendering(1);
    made->SetMultiSamples(0);
    made->SwapBuffersOff();
    return made;
  }();
  return window;
}

/// The shapes of all panels, the mean of the passes.
void draw_shapes(const std::vector<Panel*>& panels, Canvas& canvas) {
  vtkRenderWindow* window = shared_window();
  window->SetSize(canvas.width(), canvas.height());
  for (Panel* panel : panels) {
    window->AddRenderer(panel->renderer());
  }
  std::vector<unsigned char>& bytes = canvas.bytes();
  std::vector<std::uint16_t> sums(bytes.size(), kSamples.size() / 2);
  vtkNew<vtkUnsignedCharArray> pixels;
  for (const auto& [x, y] : kSamples) {
    for (Panel* panel : panels) {
      panel->shift(x, y);
    }
    window->Render();
    // As the renderer has them, with their opacity: no conversion.
    window->GetRGBACharPixelData(0, 0, canvas.width() - 1, canvas.height() - 1,
                                 0, pixels);
    if (static_cast<std::size_t>(pixels->GetNumberOfValues()) / 4 !=
        sums.size() / 3) {
      throw IoError("the renderer gave no picture");
    }
    const unsigned char* from = pixels->GetPointer(0);
    for (std::size_t i = 0; i < sums.size(); i += 3, from += 4) {
      for (std::size_t c = 0; c < 3; ++c) {
        sums[i + c] = static_cast<std::uint16_t>(sums[i + c] + from[c]);
      }
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    bytes[i] = static_cast<unsigned char>(sums[i] / kSamples.size());
  }
  for (Panel* panel : panels) {
    window->RemoveRenderer(panel->renderer());
  }
}

}  // namespace

void save_picture(const std::vector<Panel*>& panels, int width, int height,
                  const std::string& path) {
  Canvas canvas(width, height);
  draw_shapes(panels, canvas);
  for (const Panel* panel : panels) {
    panel->finish(canvas);
  }
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetArray(canvas.bytes().data(),
                    static_cast<vtkIdType>(canvas.bytes().size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->GetPointData()->SetScalars(colours);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(kCompression);
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  if (bytes == nullptr || bytes->GetNumberOfValues() == 0) {
    throw IoError(fmt::format("cannot encode the picture '{}'", path));
  }
  write_file(path, {reinterpret_cast<const char*>(bytes->GetPointer(0)),
                    static_cast<std::size_t>(bytes->GetNumberOfValues())});
}

}  // namespace meniscus::render
