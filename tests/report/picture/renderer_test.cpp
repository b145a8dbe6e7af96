#include "report/picture/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <future>
#include <optional>
#include <set>
#include <thread>
#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/find_program.h"
#include "core/timer.h"
#include "io/vtk_files.h"
#include "report/render/eye_view.h"
#include "tests/support/environment_variable.h"
#include "tests/support/not_here.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::picture_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A bent bar on z0, loaded on z1, as a run leaves it, and jobs for it.
class PictureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const TetMesh mesh =
        shapes::straight_quadratic(shapes::brick(Vec3(20, 10, 60), 2, 1, 6));
    io::MeshFields fields;
    fields.points = {{"displacement", "mm", 3, {}},
                     {"von_mises", "MPa", 1, {}}};
    io::Field& u = fields.points[0];
    io::Field& s = fields.points[1];
    for (const Vec3& p : mesh.nodes) {
      u.values.insert(u.values.end(), {1e-4 * p.z() * p.z(), 0.0, 0.0});
      s.values.push_back(200.0 * (1.0 - p.z() / 60.0));
    }
    io::write_vtu(folder_ / "part.vtu", mesh, fields);
    io::write_boundary_vtp(folder_ / "part_surface.vtp", mesh, fields);
    io::write_vtp(folder_ / "film.vtp", io::boundary_surface(mesh).mesh);
  }

  void TearDown() override { ::unsetenv("MENISCUS_RENDER"); }

  picture::PictureJob job(picture::PictureKind kind,
                          const std::string& name) const {
    picture::PictureJob job;
    job.kind = kind;
    job.output = (folder_ / name).string();
    job.part.file = (folder_ / "part.vtu").string();
    job.part_surface.file = (folder_ / "part_surface.vtp").string();
    job.film.file = (folder_ / "film.vtp").string();
    job.title = "Träger";
    job.width = 400;
    job.height = 300;
    job.supports = {"z0"};
    job.solids = {"z0", "z1"};
    job.loads = {{{"z1"}, Vec3(100, 0, 0), "100 N"}};
    return job;
  }

  TempFolder folder_;
};

/// Of a picture of this size; none where it is not. Height 0: any.
std::set<std::array<int, 3>> colours_of(const std::string& path, int width,
                                        int height) {
  std::set<std::array<int, 3>> colours;
  if (!fs::exists(path)) {
    return colours;
  }
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  const int rows = image->GetDimensions()[1];
  if (image->GetDimensions()[0] != width || (height > 0 && rows != height)) {
    return colours;
  }
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto* p =
          static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      colours.insert({p[0], p[1], p[2]});
    }
  }
  return colours;
}

void expect_picture(const std::string& path, int width, int height) {
  // White paper, ink and grey alone stay below; shading and colour map do not.
  EXPECT_GT(colours_of(path, width, height).size(), 500u) << path;
}

TEST_F(PictureTest, DrawsAllKinds) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  // Neither a display nor a home folder is needed.
  const EnvironmentVariable display("DISPLAY", std::nullopt);
  const EnvironmentVariable home("HOME", std::nullopt);
  std::vector<picture::PictureJob> jobs = {
      job(picture::PictureKind::Part, "part größe.png"),
      job(picture::PictureKind::Film, "film.png"),
      job(picture::PictureKind::Overview, "overview.png")};
  jobs[1].facet_edges = true;
  jobs[2].width = 900;
  EXPECT_THAT(picture::render_pictures(jobs), IsEmpty());
  expect_picture(jobs[0].output, 400, 300);
  expect_picture(jobs[1].output, 400, 300);
  // The bar is 60 high and 20 wide: as tall as an overview gets.
  expect_picture(jobs[2].output, 900, 570);
}

TEST(EyeView, SeesHowTallThingsAre) {
  const Points box = shapes::box(Vec3(2, 1, 6), 1).points;
  EXPECT_NEAR(render::seen_aspect(box, Vec3(0, -1, 0)), 3.0, 1e-12);
  EXPECT_NEAR(render::seen_aspect(box, Vec3(1, 0, 0)), 6.0, 1e-12);
  EXPECT_NEAR(render::seen_aspect(box, Vec3(0, 0, 1)), 0.5, 1e-12);
  EXPECT_EQ(render::seen_aspect({}, Vec3(0, 0, 1)), 1.0);
}

// The legend's field in the colour of films, unshaded.
TEST_F(PictureTest, APartOfPlaneFacesShowsNoFilm) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  std::vector<picture::PictureJob> jobs = {
      job(picture::PictureKind::Overview, "film.png"),
      job(picture::PictureKind::Overview, "faces.png")};
  jobs[1].solids = {"x0", "x1", "y0", "y1", "z0", "z1"};
  for (picture::PictureJob& job : jobs) {
    job.width = 900;
  }
  EXPECT_THAT(picture::render_pictures(jobs), IsEmpty());
  constexpr std::array<int, 3> kFilm = {92, 179, 237};
  EXPECT_EQ(colours_of(jobs[0].output, 900, 0).count(kFilm), 1u);
  expect_picture(jobs[1].output, 900, 0);
  EXPECT_EQ(colours_of(jobs[1].output, 900, 0).count(kFilm), 0u);
}

TEST_F(PictureTest, OneBadJobDoesNotStopTheNext) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  std::vector<picture::PictureJob> jobs = {
      job(picture::PictureKind::Part, "a.png"),
      job(picture::PictureKind::Film, "b.png")};
  jobs[0].part_surface.file = (folder_ / "absent.vtp").string();
  EXPECT_THAT(
      picture::render_pictures(jobs),
      ElementsAre(testing::AllOf(HasSubstr("a.png"), HasSubstr("absent.vtp"))));
  EXPECT_FALSE(fs::exists(jobs[0].output));
  EXPECT_TRUE(fs::exists(jobs[1].output));
}

TEST_F(PictureTest, WarnsWithoutAnyDisplay) {
  const EnvironmentVariable display("DISPLAY", std::nullopt);
  const EnvironmentVariable path("PATH", "/nonexistent");
  EXPECT_THAT(
      picture::render_pictures({job(picture::PictureKind::Part, "a.png")}),
      ElementsAre(HasSubstr("xvfb")));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

// VTK aborts its process here; ours goes on.
TEST_F(PictureTest, WarnsWhenTheDisplayIsUnusable) {
  const EnvironmentVariable display("DISPLAY", ":47111");
  const EnvironmentVariable path("PATH", "/nonexistent");
  EXPECT_THAT(
      picture::render_pictures({job(picture::PictureKind::Part, "a.png")}),
      ElementsAre(HasSubstr("pictures are missing")));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(PictureTest, WarnsWhenTheHelperIsMissingOrFailsOrHangs) {
  const std::vector<picture::PictureJob> jobs = {
      job(picture::PictureKind::Part, "a.png")};
  ::setenv("MENISCUS_RENDER", "/nonexistent/render", 1);
  EXPECT_THAT(picture::render_pictures(jobs),
              ElementsAre(HasSubstr("MENISCUS_RENDER")));
  ::setenv("MENISCUS_RENDER", "/bin/false", 1);
  EXPECT_EQ(picture::render_pictures(jobs).size(), 1u);
  const fs::path hanging = folder_ / "hanging";
  write_file(hanging, "#!/bin/sh\nsleep 60\n");
  fs::permissions(hanging, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", hanging.c_str(), 1);
  EXPECT_THAT(picture::render_pictures(jobs, {.time_limit = 0.3}),
              ElementsAre(HasSubstr("time limit")));
}

TEST_F(PictureTest, StopsOnRequest) {
  struct Stopper : Monitor {
    bool stop_requested() const override { return true; }
  } stopper;
  const fs::path hanging = folder_ / "hanging";
  write_file(hanging, "#!/bin/sh\nsleep 60\n");
  fs::permissions(hanging, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", hanging.c_str(), 1);
  if (find_program("Xvfb")) {
    EXPECT_THROW(
        picture::render_pictures({job(picture::PictureKind::Part, "a.png")},
                                 {.monitor = &stopper}),
        Interrupted);
  }
}

/// What an X server says to a client that knocks with `key`, empty for none: 1
/// come in, 0 refused.
int knock(const std::string& display, const std::string& key) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "/tmp/.X11-unix/X" + display.substr(1);
  name.copy(address.sun_path, sizeof address.sun_path - 1);
  std::string words("l\0\x0b\0\0\0\0\0\0\0\0\0", 12);
  if (!key.empty()) {
    words[6] = 18;
    words[8] = static_cast<char>(key.size());
    words += std::string("MIT-MAGIC-COOKIE-1\0\0", 20) + key;
  }
  char answer = -1;
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address),
                sizeof address) == 0 &&
      ::write(socket, words.data(), words.size()) ==
          static_cast<ssize_t>(words.size())) {
    EXPECT_EQ(::read(socket, &answer, 1), 1);
  }
  ::close(socket);
  return answer;
}

// Whoever could open the display could read the pictures, and draw into them.
TEST_F(PictureTest, TheDisplayOpensToItsKeyOnly) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  const fs::path waiting = folder_ / "waiting";
  write_file(waiting, fmt::format("#!/bin/sh\ncd '{}'\necho \"$DISPLAY\" > "
                                  "name\ncp \"$XAUTHORITY\" part\nmv part "
                                  "key\nsleep 60\n",
                                  folder_.path().string()));
  fs::permissions(waiting, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", waiting.c_str(), 1);
  picture::Renderer renderer;
  const picture::PicturesBeside pictures(
      renderer, {job(picture::PictureKind::Part, "a.png")}, nullptr);
  const Timer timer;
  while (!fs::exists(folder_ / "key") && timer.seconds() < 30.0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::string display = read_file(folder_ / "name");
  display.pop_back();
  const std::string file = read_file(folder_ / "key");
  const std::string key = file.substr(file.size() - 16);
  EXPECT_EQ(knock(display, ""), 0);
  EXPECT_EQ(knock(display, std::string(16, 'x')), 0);
  EXPECT_EQ(knock(display, key), 1);
}

TEST_F(PictureTest, ShapesInMemoryLookLikeThoseInFiles) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  const picture::PictureJob from_file =
      job(picture::PictureKind::Film, "file.png");
  picture::PictureJob from_memory =
      job(picture::PictureKind::Film, "memory.png");
  picture::PictureSurface surface;
  surface.mesh = io::boundary_surface(shapes::straight_quadratic(shapes::brick(
                                          Vec3(20, 10, 60), 2, 1, 6)))
                     .mesh;
  from_memory.film = {std::make_shared<const picture::PictureSurface>(surface),
                      ""};
  EXPECT_THAT(picture::render_pictures({from_file, from_memory}), IsEmpty());
  EXPECT_EQ(read_file(from_file.output), read_file(from_memory.output));
}

TEST_F(PictureTest, BesideTheCallersWork) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  picture::Renderer renderer;
  picture::PicturesBeside pictures(
      renderer, {job(picture::PictureKind::Part, "a.png")}, nullptr);
  EXPECT_THAT(pictures.wait(), IsEmpty());
  expect_picture((folder_ / "a.png").string(), 400, 300);
}

// The helper is a script that notes each of its starts.
TEST_F(PictureTest, OneHelperDrawsListAfterListAndAnotherAfterItsEnd) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  const fs::path counting = folder_ / "counting";
  write_file(
      counting,
      fmt::format("#!/bin/sh\necho $$ >> '{}'\nexec '{}'\n",
                  (folder_ / "starts").string(),
                  find_helper("meniscus-render", "MENISCUS_RENDER")->string()));
  fs::permissions(counting, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", counting.c_str(), 1);
  picture::Renderer renderer;
  const auto draw = [&](picture::PictureKind kind, const std::string& name) {
    return renderer.render({job(kind, name)});
  };
  EXPECT_THAT(draw(picture::PictureKind::Part, "a.png"), IsEmpty());
  EXPECT_THAT(draw(picture::PictureKind::Film, "b.png"), IsEmpty());
  EXPECT_THAT(draw(picture::PictureKind::Part, "c.png"), IsEmpty());
  // What was drawn between leaves no trace, nor does the size.
  EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "c.png"));
  std::vector<std::future<std::vector<std::string>>> several;
  for (const char* name : {"d.png", "e.png"}) {
    several.push_back(
        renderer.begin({job(picture::PictureKind::Part, name)}, {}));
  }
  for (auto& one : several) {
    EXPECT_THAT(one.get(), IsEmpty());
  }
  EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "e.png"));
  const std::string first = read_file(folder_ / "starts");
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 1);
  ::kill(std::stoi(first), SIGKILL);
  EXPECT_THAT(draw(picture::PictureKind::Part, "f.png"), IsEmpty());
  const std::string both = read_file(folder_ / "starts");
  EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 2);
  EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "f.png"));
}

// Lists that wait when the Renderer ends are given up.
TEST_F(PictureTest, ListsThatWaitEndWithTheRenderer) {
  if (!find_program("Xvfb")) {
    MENISCUS_NOT_HERE("Xvfb is not installed");
  }
  const fs::path hanging = folder_ / "hanging";
  write_file(hanging, "#!/bin/sh\nsleep 60\n");
  fs::permissions(hanging, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", hanging.c_str(), 1);
  std::future<std::vector<std::string>> waiting;
  {
    picture::Renderer renderer;
    const auto drawn = renderer.begin(
        {job(picture::PictureKind::Part, "a.png")}, {.time_limit = 0.3});
    waiting = renderer.begin({job(picture::PictureKind::Part, "b.png")}, {});
  }
  EXPECT_THROW(waiting.get(), Interrupted);
}

TEST_F(PictureTest, GivenUpWithTheCallersWork) {
  const fs::path hanging = folder_ / "hanging";
  write_file(hanging, "#!/bin/sh\nsleep 60\n");
  fs::permissions(hanging, fs::perms::owner_all);
  ::setenv("MENISCUS_RENDER", hanging.c_str(), 1);
  picture::Renderer renderer;
  const Timer timer;
  {
    const picture::PicturesBeside given_up(
        renderer, {job(picture::PictureKind::Part, "a.png")}, nullptr);
  }
  EXPECT_LT(timer.seconds(), 30.0);  // of the 60 that it would take
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST(PictureJobs, SurviveTheirBytes) {
  picture::PictureJob job;
  job.kind = picture::PictureKind::Film;
  job.output = "größe \"x\" \xff.png";  // a path need not be UTF-8
  job.loads = {{{"pad"}, Vec3(0.1, -2, 3), "5 N"},
               {.surfaces = {"lug_1", "lug_2"},
                .direction = Vec3(0, 0, 1),
                .label = "7 N",
                .point = Vec3(4, 0.3, -1)}};
  job.view = Vec3(1, 2, 3);
  job.facet_edges = true;
  job.hidden = {"lid_*"};
  job.part_surface.file = "part.vtp";
  picture::PictureSurface surface;
  surface.mesh = shapes::box(Vec3(1, 2, 3), 2);
  surface.von_mises.assign(surface.mesh.points.size(), 0.1);
  job.film.data = std::make_shared<const picture::PictureSurface>(surface);
  const auto jobs =
      picture::picture_jobs_from_bytes(picture::to_bytes({job, job}));
  ASSERT_EQ(jobs.size(), 2u);
  EXPECT_EQ(jobs[0].kind, job.kind);
  EXPECT_EQ(jobs[0].output, job.output);
  EXPECT_EQ(jobs[0].loads.at(0).direction, job.loads[0].direction);
  EXPECT_FALSE(jobs[0].loads[0].point.has_value());
  EXPECT_EQ(jobs[0].loads.at(1).surfaces, job.loads[1].surfaces);
  EXPECT_EQ(jobs[0].loads[1].point, job.loads[1].point);
  EXPECT_EQ(jobs[0].view, job.view);
  EXPECT_TRUE(jobs[0].facet_edges);
  EXPECT_EQ(jobs[0].hidden, job.hidden);
  EXPECT_EQ(jobs[0].part_surface.file, "part.vtp");
  EXPECT_EQ(jobs[0].film.data, jobs[1].film.data);
  EXPECT_EQ(jobs[0].film.data->mesh.points, surface.mesh.points);
  EXPECT_EQ(jobs[0].film.data->mesh.facets, surface.mesh.facets);
  EXPECT_EQ(jobs[0].film.data->von_mises, surface.von_mises);
}

TEST(PictureJobs, RefuseWhatDoesNotFit) {
  EXPECT_THROW(picture::picture_jobs_from_bytes("{"), InvalidInput);
  picture::PictureJob job;
  job.width = 100;
  EXPECT_THROW(picture::picture_jobs_from_bytes(picture::to_bytes({job})),
               InvalidInput);
  job.width = 400;
  picture::PictureSurface surface;
  surface.mesh = shapes::box(Vec3(1, 2, 3), 2);
  surface.mesh.facets[0][1] = 10000;
  job.film.data = std::make_shared<const picture::PictureSurface>(surface);
  EXPECT_THROW(picture::picture_jobs_from_bytes(picture::to_bytes({job})),
               InvalidInput);
  const std::string bytes = picture::to_bytes({job});
  EXPECT_THROW(
      picture::picture_jobs_from_bytes(bytes.substr(0, bytes.size() / 2)),
      InvalidInput);
}

}  // namespace
}  // namespace meniscus::picture_test
