#include "app/terminal_monitor.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace meniscus::terminal_monitor_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// A monitor on a stream in memory, with a clock that the test moves.
class TerminalMonitorTest : public testing::Test {
 protected:
  TerminalMonitorTest() : stream_(open_memstream(&text_, &size_)) {}
  ~TerminalMonitorTest() override {
    std::fclose(stream_);
    std::free(text_);
  }

  app::TerminalMonitorOptions options(app::MonitorStyle style) {
    return {.style = style,
            .stream = stream_,
            .clock = [this] { return time_; },
            .columns = 40};
  }
  std::string shown() {
    std::fflush(stream_);
    return {text_, size_};
  }

  double time_ = 100.0;

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

TEST_F(TerminalMonitorTest, PipesGetTheFirstLineOfAStageAndSignsOfLife) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Lines));
  for (int i = 0; i < 25; ++i) {
    time_ = 100.0 + i;
    monitor.progress({"film", "step " + std::to_string(i), -1.0});
    monitor.progress({"fea", "", -1.0});
  }
  EXPECT_EQ(shown(), "film: step 0\nfea\nfilm: step 10\nfilm: step 20\n");
}

TEST_F(TerminalMonitorTest, EventsTellMoreThanTheOuterStage) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Terminal));
  monitor.progress({"match", "before", -1.0});
  monitor.write({.line = "evaluation 1: good",
                 .status = "match: evaluation 1",
                 .fields = {}});
  monitor.progress({"match", "the same in fewer words", -1.0});
  monitor.progress({"fea", "step 3", -1.0});
  EXPECT_THAT(shown(), HasSubstr("\r\x1b[Kevaluation 1: good\n"));
  EXPECT_THAT(shown(), HasSubstr("match: evaluation 1 | fea: step 3"));
  EXPECT_THAT(shown(), Not(HasSubstr("fewer words")));
}

TEST_F(TerminalMonitorTest, AutomaticStyleTakesAPipeForLines) {
  std::FILE* file = std::tmpfile();
  app::TerminalMonitorOptions automatic;
  automatic.stream = file;
  { app::TerminalMonitor(automatic).progress({"film", "step 1", -1.0}); }
  std::rewind(file);
  char line[64] = {};
  ASSERT_NE(std::fgets(line, sizeof line, file), nullptr);
  EXPECT_STREQ(line, "film: step 1\n");
  std::fclose(file);
}

TEST_F(TerminalMonitorTest, TerminalsRedrawOneLine) {
  {
    app::TerminalMonitor monitor(options(app::MonitorStyle::Terminal));
    monitor.progress({"film", "step 1", -1.0});
    monitor.progress({"film", "step 2", -1.0});  // too soon to be drawn
    time_ += 0.2;
    monitor.progress({"film", "step 3", -1.0});
    monitor.log(Severity::Warning, "volume is large");
  }
  EXPECT_EQ(shown(),
            "film: step 1"
            "\r\x1b[Kfilm: step 3"
            "\r\x1b[Kwarning: volume is large\nfilm: step 3"
            "\r\x1b[K");
}

TEST_F(TerminalMonitorTest, KeepsTheOuterStageInView) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Terminal));
  monitor.progress({"match", "best 0.2", -1.0});
  monitor.progress({"fea", "iteration 3", -1.0});
  EXPECT_THAT(shown(), HasSubstr("match: best 0.2 | fea: iteration 3"));
}

TEST_F(TerminalMonitorTest, TellsTheTimeLeft) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Lines));
  monitor.progress({"fea", "", 0.0});
  time_ += 10.0;
  monitor.progress({"fea", "solving", 0.25});
  EXPECT_EQ(shown(), "fea (0 %)\nfea: solving (25 %, 30 s left)\n");
}

TEST_F(TerminalMonitorTest, CutsTheStatusToTheTerminal) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Terminal));
  monitor.progress({"film", std::string(30, 'a') + "\nÄÖÜÄÖÜÄÖÜ", -1.0});
  // 39 columns of text; two bytes for each umlaut
  EXPECT_EQ(shown(), "film: " + std::string(30, 'a') + " ÄÖ");
}

TEST_F(TerminalMonitorTest, QuietShowsErrorsOnly) {
  app::TerminalMonitor monitor(options(app::MonitorStyle::Quiet));
  monitor.progress({"film", "step 1", -1.0});
  monitor.log(Severity::Info, "hello");
  monitor.log(Severity::Warning, "careful");
  monitor.log(Severity::Error, "disk full");
  EXPECT_EQ(shown(), "error: disk full\n");
}

TEST_F(TerminalMonitorTest, LogsJsonLines) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("meniscus_log_" + std::to_string(std::rand()));
  app::TerminalMonitorOptions with_log = options(app::MonitorStyle::Lines);
  with_log.log_file = path.string();
  {
    app::TerminalMonitor monitor(with_log);
    monitor.log(Severity::Debug, "a \"quoted\" detail");
    monitor.progress({"fea", "iteration 1", 0.5});
    monitor.progress({"fea", "iteration 2", 0.6});
    monitor.write({.line = {},
                   .status = {},
                   .fields = {{"event", "end"}, {"stage", "run"}}});
  }
  EXPECT_THAT(shown(), Not(HasSubstr("quoted")));
  std::ifstream file(path);
  std::string line;
  std::vector<nlohmann::json> lines;
  while (std::getline(file, line)) {
    lines.push_back(nlohmann::json::parse(line));
  }
  std::filesystem::remove(path);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0]["level"], "debug");
  EXPECT_EQ(lines[0]["message"], "a \"quoted\" detail");
  EXPECT_EQ(lines[0]["time"].get<std::string>().size(), 24U);
  EXPECT_EQ(lines[1]["stage"], "fea");
  EXPECT_EQ(lines[1]["fraction"], 0.5);
  EXPECT_EQ(lines[1]["event"], "progress");
  EXPECT_EQ(lines[2]["event"], "end");
  EXPECT_EQ(lines[2]["seconds"], 0.0);
}

TEST_F(TerminalMonitorTest, ALogThatAKillCutShortGoesOnInALineOfItsOwn) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("meniscus_log_" + std::to_string(std::rand()));
  std::ofstream(path) << "{\"whole\": 1}\n{\"cut";
  {
    app::JsonLog log(path.string());
    EXPECT_TRUE(log.write({{"event", "message"}}));
  }
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  EXPECT_THAT(text, HasSubstr("{\"cut\n{\"time\""));
  EXPECT_EQ(text.back(), '\n');
}

TEST_F(TerminalMonitorTest, ALogThatCannotBeOpenedIsRefused) {
  app::TerminalMonitorOptions with_log = options(app::MonitorStyle::Lines);
  with_log.log_file = "/nonexistent folder/log";
  EXPECT_THROW(app::TerminalMonitor{with_log}, IoError);
}

TEST_F(TerminalMonitorTest, AFullDiskEndsTheLogNotTheRun) {
  app::TerminalMonitorOptions with_log = options(app::MonitorStyle::Lines);
  with_log.log_file = "/dev/full";
  app::TerminalMonitor monitor(with_log);
  monitor.log(Severity::Info, "one");
  monitor.log(Severity::Info, "two");
  EXPECT_THAT(shown(), HasSubstr("'/dev/full' ends here"));
  EXPECT_THAT(shown(), HasSubstr("two\n"));
}

TEST_F(TerminalMonitorTest, AsksItsStopFunction) {
  bool stop = false;
  app::TerminalMonitorOptions stoppable = options(app::MonitorStyle::Lines);
  stoppable.stop = [&stop] { return stop; };
  const app::TerminalMonitor monitor(stoppable);
  EXPECT_FALSE(monitor.stop_requested());
  stop = true;
  EXPECT_TRUE(monitor.stop_requested());
  EXPECT_FALSE(
      app::TerminalMonitor(options(app::MonitorStyle::Quiet)).stop_requested());
}

}  // namespace
}  // namespace meniscus::terminal_monitor_test
