#include "core/frame.h"

#include <csignal>

#include <gtest/gtest.h>

#include "core/child_process.h"
#include "core/error.h"
#include "core/heed_stop.h"
#include "core/types.h"

namespace meniscus::frame_test {
namespace {

const std::string kText("h\0le", 4);

std::string message() {
  FrameWriter out;
  out.put(7);
  out.put_text(kText);
  out.put_array(std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
  out.put_array(std::vector<int>{});
  return out.bytes();
}

TEST(Frame, ValuesComeBack) {
  const std::string bytes = message();
  FrameReader in(bytes);
  EXPECT_EQ(in.get<int>(), 7);
  EXPECT_EQ(in.get_text(), kText);
  EXPECT_EQ(in.get_array<Vec3>(), (Points{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  EXPECT_TRUE(in.get_array<int>().empty());
  EXPECT_TRUE(in.at_end());
}

TEST(Frame, NoPartOfAMessageIsReadBeyondItsEnd) {
  const std::string bytes = message();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    FrameReader in(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(
        {
          in.get<int>();
          in.get_text();
          in.get_array<Vec3>();
          in.get_array<int>();
        },
        IoError)
        << size;
  }
  std::string wrong = bytes;
  wrong[sizeof(int) + 7] = '\x7f';  // a text of 2^62 bytes and more
  FrameReader in(wrong);
  in.get<int>();
  EXPECT_THROW(in.get_text(), IoError);
}

TEST(Frame, AChildAnswersQuestionAfterQuestion) {
  ChildOptions options;
  options.argv = {"cat"};  // each frame comes back as it is
  AskedChild child(options);
  const std::string large(3'000'000, 'x');
  for (const std::string& question :
       {std::string("one"), large, std::string(), std::string("four")}) {
    EXPECT_EQ(child.ask(question), question);
  }
}

TEST(Frame, AChildThatDoesNotAnswerSaysHowItEnded) {
  ChildOptions options;
  options.argv = {"sh", "-c", "kill -SEGV $$"};
  AskedChild dead(options);
  EXPECT_FALSE(dead.ask("x"));
  EXPECT_EQ(dead.end().signal, SIGSEGV);
  EXPECT_FALSE(dead.ask("y"));
  options.argv = {"sleep", "60"};
  options.time_limit = 0.2;
  AskedChild late(options);
  EXPECT_FALSE(late.ask("x"));
  EXPECT_TRUE(late.end().timed_out);
  struct Stopper : Monitor {
    bool stop_requested() const override { return true; }
  } stopper;
  options.time_limit.reset();
  options.monitor = &stopper;
  AskedChild stopped(options);
  EXPECT_FALSE(stopped.ask("x"));
  EXPECT_TRUE(stopped.end().stopped);
}

TEST(HeedStop, AsksTheInnermostMonitorOfItsThread) {
  struct Stopper : Monitor {
    bool stop_requested() const override { return true; }
  } stopper;
  // Asked once in 20 ms.
  const auto loop = [] {
    for (int k = 0; k < 2'000'000; ++k) {
      heed_stop("the test");
      if (k % 1000 == 0 && k > 1'000'000) {
        return;
      }
    }
  };
  EXPECT_NO_THROW(heed_stop("nobody listens"));
  const Heeding outer(&stopper);
  {
    const Heeding deaf(&silent_monitor());
    EXPECT_NO_THROW(loop());
    const Heeding same(nullptr);
    EXPECT_NO_THROW(loop());
  }
  EXPECT_THROW(loop(), Interrupted);
}

}  // namespace
}  // namespace meniscus::frame_test
