#include "report/save_picture.h"

#include <cstddef>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

namespace meniscus {

namespace {

// Of 0 to 9: a tenth more bytes than 6, in a third of its time.
constexpr int kCompression = 3;

}  // namespace

void save_picture(const std::vector<Panel*>& panels, int width, int height,
                  const std::string& path) {
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);  // they do not go with depth peeling
  window->SetAlphaBitPlanes(1);
  window->SetSize(width * kSupersampling, height * kSupersampling);
  for (Panel* panel : panels) {
    window->AddRenderer(panel->renderer());
  }
  window->Render();
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->SetInputBufferTypeToRGB();
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  grab->Update();
  vtkImageData* large = grab->GetOutput();
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* from =
      static_cast<const unsigned char*>(large->GetScalarPointer());
  auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
  constexpr int s = kSupersampling;
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(width) * s * 3;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        int sum = s * s / 2;
        for (int i = 0; i < s * s; ++i) {
          const std::ptrdiff_t pixel = std::ptrdiff_t{s} * x + i % s;
          sum += from[(std::ptrdiff_t{s} * y + i / s) * row + 3 * pixel + c];
        }
        *to++ = static_cast<unsigned char>(sum / (s * s));
      }
    }
  }
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

}  // namespace meniscus
