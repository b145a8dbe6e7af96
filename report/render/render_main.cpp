/// meniscus-render: draws lists of picture jobs (picture_job.h) that come on
/// stdin, and answers each on stdout with what failed (core/frame.h). Needs a
/// display; the program that starts it sees to that
/// (report/picture/renderer.h).
#include <algorithm>
#include <exception>
#include <string>
#include <unistd.h>
#include <vector>
#include <vtkObject.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/frame.h"
#include "report/render/render_views.h"
#include "report/render/save_picture.h"

namespace meniscus::render {
namespace {

constexpr Colour kGrey = {0.38, 0.42, 0.48};

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// 12,345
std::string grouped(std::size_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) {
      text += ',';
    }
    text += digits[i];
  }
  return text;
}

/// "load case 'lift' (the worst of 3): "; nothing without a name.
std::string case_text(const picture::PictureJob& job) {
  return job.load_case.empty() ? "" : "load case " + job.load_case + ": ";
}

std::shared_ptr<const picture::PictureSurface> stressed_part(
    const picture::PictureJob& job) {
  return shape_of(job.part_surface, [&](const std::string& path) {
    return load_surface(path, job.field_ending);
  });
}

std::shared_ptr<const picture::PictureSurface> film_of(
    const picture::PictureJob& job) {
  return shape_of(job.film,
                  [](const std::string& path) { return load_surface(path); });
}

void draw_one(const picture::PictureJob& job) {
  Panel panel({0, 0, 1, 1}, job.width, job.height);
  ViewLayout layout;
  layout.text = std::max(12, job.height / 42);
  std::string line;
  if (job.kind == picture::PictureKind::Part) {
    const auto part = stressed_part(job);
    const PartFigures figures = draw_part(panel, job, *part, layout);
    line = fmt::format(
        "{}deflection drawn \u00d7 {:g} (largest {}), peak stress {}",
        case_text(job), figures.factor,
        with_unit(figures.largest, part->length_unit),
        with_unit(figures.peak, part->stress_unit));
  } else {
    layout.model = {0.05, 0.05, 0.95, 0.87};
    const auto film = film_of(job);
    picture::PictureSurface shown;
    shown.mesh = without(film->mesh, job.hidden);
    draw_film(panel, job, shown);
    line = job.caption;
  }
  panel.fit_camera(job.view, layout.model);
  panel.add_axes(job.length_unit, layout.text * 4 / 5);
  panel.add_text(0.025, 1.0 - 2.2 * layout.text / job.height, job.title,
                 {.size = layout.text * 3 / 2, .bold = true});
  panel.add_text(0.025, 1.0 - 4.0 * layout.text / job.height, line,
                 {.size = layout.text, .colour = kGrey});
  save_picture({&panel}, job.width, job.height, job.output);
}

/// Where the panels of an overview have their things, and its height [pixel].
struct OverviewLayout {
  ViewLayout view;
  int height = 0;
};

/// A part taller than a panel is wide gets a taller picture.
/// `share`: a panel's of the width.
OverviewLayout overview_layout(const picture::PictureJob& job,
                               const Points& film, double share) {
  constexpr double kHead = 0.14;    // x the height asked for: titles
  constexpr double kFoot = 0.22;    // bar and legends
  constexpr double kTallest = 1.9;  // x the height asked for
  constexpr double kMargin = 0.02;  // x the panel's width
  const double asked = job.height;
  const double panel = share * job.width;
  const double tall =
      seen_aspect(film, job.view) * (1.0 - 2.0 * kMargin) * panel +
      (kHead + kFoot) * asked;
  OverviewLayout layout;
  layout.height = static_cast<int>(std::clamp(tall, asked, kTallest * asked));
  const double part = asked / layout.height;
  layout.view.text = std::max(11, job.height / 30);
  layout.view.model = {kMargin, kFoot * part, 1.0 - kMargin,
                       1.0 - kHead * part};
  layout.view.bar = {0.15, 0.105 * part, 0.85, 0.13 * part};
  return layout;
}

void draw_overview(const picture::PictureJob& job) {
  const auto surface = film_of(job);
  const auto tets = shape_of(job.part, load_tets);
  const bool solid = !tets->corners.empty();  // shells have no inside
  const double share = solid ? 1.0 / 3 : 1.0 / 2;
  const OverviewLayout overview =
      overview_layout(job, surface->mesh.points, share);
  const ViewLayout& layout = overview.view;
  const int height = overview.height;
  Panel film({0, 0, share, 1}, job.width, height);
  Panel mesh({1.0 / 3, 0, 2.0 / 3, 1}, job.width, height);
  Panel part({1.0 - share, 0, 1, 1}, job.width, height);
  const bool liquid = draw_film(film, job, *surface);
  const PartFigures figures = draw_part(part, job, *stressed_part(job), layout);
  const auto caption = [&](Panel& panel, const std::string& title,
                           const std::string& line) {
    const double row = layout.text / static_cast<double>(height);
    panel.add_text(0.5, 1.0 - 2.0 * row, title,
                   {.size = layout.text * 5 / 4,
                    .bold = true,
                    .justify = Justify::Centre});
    panel.add_text(
        0.5, 1.0 - 3.5 * row, line,
        {.size = layout.text, .colour = kGrey, .justify = Justify::Centre});
    // One scale and one eye for all.
    if (&panel != &part) {
      panel.show(part.shown());
    }
    panel.fit_camera(job.view, layout.model);
  };
  caption(film, liquid ? "Liquid film" : "Plane faces",
          fmt::format("{} facets{}", grouped(surface->mesh.facets.size()),
                      liquid ? " at rest" : ""));
  if (solid) {
    draw_cut_mesh(mesh, job, *tets);
    caption(mesh, "Solid, cut open",
            fmt::format("{} tetrahedra", grouped(tets->corners.size())));
    mesh.add_legend(layout.bar.bottom,
                    {{kOutsideColour, "surface"}, {kInsideColour, "inside"}},
                    layout.text);
  }
  caption(
      part, "Stress under load",
      fmt::format("{}deflection \u00d7 {:g}", case_text(job), figures.factor));
  film.add_axes(job.length_unit, layout.text * 4 / 5);
  std::vector<Panel::Key> keys = {
      {kCapColour, liquid ? "cap" : "face"},
      {kRimColour, liquid ? "boundary curve" : "edge"}};
  if (liquid) {
    keys.insert(keys.begin(), {kFilmColour, "film"});
  }
  film.add_legend(layout.bar.bottom, keys, layout.text);
  std::vector<Panel*> panels = {&film, &part};
  if (solid) {
    panels.insert(panels.begin() + 1, &mesh);
  }
  save_picture(panels, job.width, height, job.output);
}

/// What failed, a line each; empty when all are drawn.
std::string draw_all(const std::vector<picture::PictureJob>& jobs) {
  std::string failed;
  for (const picture::PictureJob& job : jobs) {
    try {
      if (job.kind == picture::PictureKind::Overview) {
        draw_overview(job);
      } else {
        draw_one(job);
      }
    } catch (const std::exception& error) {
      failed += fmt::format("{}: {}\n", job.output, error.what());
    }
  }
  return failed;
}

std::string answer(const std::string& question) {
  try {
    return draw_all(picture::picture_jobs_from_bytes(question));
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace
}  // namespace meniscus::render

int main() {
  vtkObject::GlobalWarningDisplayOff();
  const int out = meniscus::take_stdout();
  while (const auto question = meniscus::read_frame(STDIN_FILENO)) {
    if (!meniscus::write_frame(out, meniscus::render::answer(*question))) {
      ::_exit(1);
    }
  }
  ::_exit(0);  // the window's context is not taken apart
}
