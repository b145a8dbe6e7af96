/// meniscus-render: draws the picture jobs that come as JSON on stdin. Needs a
/// display; the program that starts it sees to that (report/picture.h). Exit
/// code 0: all drawn; 1: stderr says what is missing; 2: no valid jobs.
#include <cstdio>
#include <iostream>
#include <iterator>
#include <vtkObject.h>

#include "core/error.h"
#include "report/render_views.h"

namespace meniscus {
namespace {

constexpr Colour kGrey = {0.38, 0.42, 0.48};

void draw_one(const PictureJob& job) {
  Panel panel({0, 0, 1, 1}, job.width, job.height);
  ViewLayout layout;
  layout.text = std::max(12, job.height / 42);
  std::string line;
  if (job.kind == PictureKind::Part) {
    line = draw_part(panel, job, load_surface(job.part_surface), layout);
  } else {
    layout.model = {0.05, 0.05, 0.95, 0.87};
    draw_film(panel, job, load_surface(job.film), layout);
  }
  panel.add_text(0.025, 1.0 - 2.2 * layout.text / job.height, job.title,
                 {.size = layout.text * 3 / 2, .bold = true});
  panel.add_text(0.025, 1.0 - 4.0 * layout.text / job.height, line,
                 {.size = layout.text, .colour = kGrey});
  save_picture({&panel}, job.width, job.height, job.output);
}

void draw_overview(const PictureJob& job) {
  ViewLayout layout;
  layout.text = std::max(11, job.height / 30);
  layout.model = {0.04, 0.22, 0.96, 0.86};
  layout.bar = {0.15, 0.105, 0.85, 0.13};
  Panel film({0, 0, 1.0 / 3, 1}, job.width, job.height);
  Panel mesh({1.0 / 3, 0, 2.0 / 3, 1}, job.width, job.height);
  Panel part({2.0 / 3, 0, 1, 1}, job.width, job.height);
  const PictureSurface stressed = load_surface(job.part_surface);
  draw_film(film, job, load_surface(job.film), layout);
  const PictureTets tets = load_tets(job.part);
  draw_cut_mesh(mesh, job, tets, layout);
  draw_part(part, job, stressed, layout);
  const TextStyle caption{
      .size = layout.text * 5 / 4, .bold = true, .justify = Justify::Centre};
  const double y = 1.0 - 2.2 * layout.text / job.height;
  film.add_text(0.5, y, "Liquid film", caption);
  mesh.add_text(0.5, y, "Solid, cut open", caption);
  part.add_text(0.5, y, "Stress under load", caption);
  save_picture({&film, &mesh, &part}, job.width, job.height, job.output);
}

int run() {
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  std::vector<PictureJob> jobs;
  try {
    jobs = picture_jobs_from_json(text);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  vtkObject::GlobalWarningDisplayOff();
  int code = 0;
  for (const PictureJob& job : jobs) {
    try {
      if (job.kind == PictureKind::Overview) {
        draw_overview(job);
      } else {
        draw_one(job);
      }
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", job.output.c_str(), error.what());
      code = 1;
    }
  }
  return code;
}

}  // namespace
}  // namespace meniscus

int main() { return meniscus::run(); }
