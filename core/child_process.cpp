#include "core/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "core/error.h"
#include "core/find_program.h"
#include "core/frame.h"

namespace meniscus {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTickMs = 50;        // how often limits and stops are looked at
constexpr int kExitTickMs = 2;     // both streams closed: the end is near
constexpr int kStartFailed = 127;  // the shell's code for "not started"

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  bool open() const { return fd_ >= 0; }
  void reset(int fd = -1) {
    if (fd_ >= 0) {
      ::close(fd_);
    }
    fd_ = fd;
  }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

struct Pipe {
  Descriptor read, write;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) {
      throw IoError(fmt::format("cannot open a pipe to a helper program: {}",
                                std::strerror(errno)));
    }
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
};

/// Stdin is a socket, not a pipe: writing to a child that has gone then gives
/// an error instead of SIGPIPE, which would end the whole program.
struct InputSocket {
  Descriptor child, parent;
  InputSocket() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
      throw IoError(fmt::format("cannot open a socket to a helper program: {}",
                                std::strerror(errno)));
    }
    child.reset(ends[0]);
    parent.reset(ends[1]);
  }
};

struct Started {
  pid_t process = -1;
  Descriptor input, output, error;  // the caller's ends
};

std::vector<std::string> make_environment(const ChildOptions& options) {
  std::vector<std::string> variables;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    const bool replaced = std::any_of(
        options.environment.begin(), options.environment.end(),
        [&](const auto& pair) { return text.starts_with(pair.first + "="); });
    if (!replaced) {
      variables.emplace_back(text);
    }
  }
  for (const auto& [name, value] : options.environment) {
    if (value) {
      variables.push_back(name + "=" + *value);
    }
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) {
    result.push_back(text.data());
  }
  result.push_back(nullptr);
  return result;
}

/// What the child needs between fork and exec, prepared before: there only
/// plain system calls are safe, other threads may hold the heap's lock.
struct Launch {
  const char* program;
  const char* folder;  // nullptr: stay
  char** argv;
  char** environment;
  int streams[3];
  int report;  // errno goes here when the start fails
  pid_t parent;
  rlim_t memory;  // RLIM_INFINITY: no limit
  int niceness;
};

[[noreturn]] void become_child(const Launch& launch) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  bool good = ::getppid() == launch.parent;
  for (int i = 0; i < 3 && good; ++i) {
    good = ::dup2(launch.streams[i], i) == i;
  }
  // Everything else closes at exec; on an old kernel the caller's own
  // close-on-exec flags have to do.
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  if (launch.memory != RLIM_INFINITY) {
    rlimit limit{launch.memory, launch.memory};
    good = good && ::setrlimit(RLIMIT_AS, &limit) == 0;
  }
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGXFSZ}) {
    ::signal(number, SIG_DFL);
  }
  sigset_t all;
  ::sigemptyset(&all);
  ::sigprocmask(SIG_SETMASK, &all, nullptr);
  if (launch.niceness > 0) {  // a wish: refused, it runs all the same
    [[maybe_unused]] const int reached = ::nice(launch.niceness);
  }
  good = good && (launch.folder == nullptr || ::chdir(launch.folder) == 0);
  if (good) {
    ::execve(launch.program, launch.argv, launch.environment);
  }
  const int why = errno;
  [[maybe_unused]] const auto sent = ::write(launch.report, &why, sizeof why);
  ::_exit(kStartFailed);
}

/// Streams above 2 whatever the caller has closed, so that dup2 in the child
/// overwrites none of them.
int lifted(Descriptor& fd) {
  if (fd.get() <= 2) {
    fd.reset(::fcntl(fd.get(), F_DUPFD_CLOEXEC, 3));
  }
  return fd.get();
}

/// At most the caller's own: nobody may raise that.
rlim_t memory_limit_of(const ChildOptions& options) {
  if (!options.memory_limit) {
    return RLIM_INFINITY;
  }
  const auto wanted = static_cast<rlim_t>(*options.memory_limit);
  rlimit own{};
  return ::getrlimit(RLIMIT_AS, &own) == 0 ? std::min(wanted, own.rlim_cur)
                                           : wanted;
}

enum class ErrorStream { Captured, Discarded };

void start(const ChildOptions& options, ErrorStream error_stream,
           Started& started) {
  if (options.argv.empty()) {
    throw InvalidInput("a helper program needs a name: argv is empty");
  }
  const auto program = find_program(options.argv.front());
  if (!program) {
    throw IoError(fmt::format(
        "cannot start '{}': no such executable file; install it or check PATH",
        options.argv.front()));
  }
  std::vector<std::string> arguments = options.argv;
  std::vector<std::string> variables = make_environment(options);
  const std::vector<char*> argv = pointers(arguments);
  const std::vector<char*> environment = pointers(variables);
  InputSocket input;
  Pipe output, error, report;
  if (error_stream == ErrorStream::Discarded) {
    error.write.reset(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  }
  Launch launch{};
  launch.program = program->c_str();
  launch.folder = options.folder.empty() ? nullptr : options.folder.c_str();
  launch.argv = const_cast<char**>(argv.data());
  launch.environment = const_cast<char**>(environment.data());
  launch.streams[0] = lifted(input.child);
  launch.streams[1] = lifted(output.write);
  launch.streams[2] = lifted(error.write);
  launch.report = lifted(report.write);
  launch.parent = ::getpid();
  launch.memory = memory_limit_of(options);
  launch.niceness = options.niceness;
  started.process = ::fork();
  if (started.process < 0) {
    throw IoError(fmt::format("cannot start '{}': {}", program->string(),
                              std::strerror(errno)));
  }
  if (started.process == 0) {
    become_child(launch);
  }
  report.write.reset();
  int why = 0;
  ssize_t got = 0;
  do {
    got = ::read(report.read.get(), &why, sizeof why);
  } while (got < 0 && errno == EINTR);
  if (got == static_cast<ssize_t>(sizeof why)) {
    ::waitpid(started.process, nullptr, 0);
    throw IoError(fmt::format("cannot start '{}': {}", program->string(),
                              std::strerror(why)));
  }
  started.input.reset(input.parent.release());
  started.output.reset(output.read.release());
  started.error.reset(error.read.release());
}

/// Whether the child has ended; it stays a zombie, so its id stays its own.
bool has_ended(pid_t process) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(process), &info,
                  WEXITED | WNOHANG | WNOWAIT) != 0 ||
         info.si_pid == process;
}

/// Kills what is left of its group and takes its status.
int reap(pid_t process) {
  ::kill(-process, SIGKILL);
  ::kill(process, SIGKILL);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void send_some(Descriptor& input, std::string_view& rest) {
  if (!rest.empty()) {
    const ssize_t sent = ::send(input.get(), rest.data(), rest.size(),
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      rest.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno != EAGAIN && errno != EINTR) {
      rest = {};  // it does not listen any more; its exit code says why
    }
  }
}

/// Reads what is there (after poll said so); closes at the end of the stream.
void receive_some(Descriptor& stream, std::string& text) {
  constexpr std::size_t kChunk = 1 << 16;
  const std::size_t before = text.size();
  text.resize(before + kChunk);
  const ssize_t got = ::read(stream.get(), text.data() + before, kChunk);
  text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) {
    stream.reset();
  }
}

/// Moves bytes for at most `timeout` ms; false when nothing came.
bool exchange_bytes(Started& child, std::string_view& rest, ChildResult& result,
                    std::size_t tail, int timeout) {
  std::array<pollfd, 3> polled = {
      {{rest.empty() ? -1 : child.input.get(), POLLOUT, 0},
       {child.output.get(), POLLIN, 0},
       {child.error.get(), POLLIN, 0}}};  // poll skips negative ones
  if (::poll(polled.data(), polled.size(), timeout) <= 0) {
    return false;
  }
  if (polled[0].revents != 0) {
    send_some(child.input, rest);
  }
  if (polled[1].revents != 0) {
    receive_some(child.output, result.output);
  }
  if (polled[2].revents != 0) {
    receive_some(child.error, result.error_tail);
    if (result.error_tail.size() > 2 * tail + 4096) {
      result.error_tail.erase(0, result.error_tail.size() - tail);
    }
  }
  return polled[1].revents != 0 || polled[2].revents != 0;
}

/// Whether a child is to be ended, and why, in its result.
bool is_over(const ChildOptions& options, Clock::time_point begin,
             ChildResult& result) {
  result.stopped =
      options.monitor != nullptr && options.monitor->stop_requested();
  result.timed_out = !result.stopped && options.time_limit &&
                     seconds_since(begin) > *options.time_limit;
  return result.stopped || result.timed_out;
}

/// Ends it, if it has not ended, and says how it ended.
void finish(pid_t process, const ChildOptions& options, ChildResult& result) {
  const int status = reap(process);
  if (WIFEXITED(status)) {
    result.exit_code = WEXITSTATUS(status);
  } else if (WIFSIGNALED(status)) {
    result.signal = WTERMSIG(status);
  }
  if (result.error_tail.size() > options.error_tail) {
    result.error_tail.erase(0, result.error_tail.size() - options.error_tail);
  }
}

}  // namespace

ChildResult run_child(const ChildOptions& options) {
  const auto begin = Clock::now();
  ChildResult result;
  Started child;
  start(options, ErrorStream::Captured, child);
  std::string_view rest = options.input;
  while (true) {
    if (rest.empty()) {
      child.input.reset();
    }
    // Asked before the streams are read: what it wrote before its end is then
    // in them, and nothing more will come.
    const bool ended = has_ended(child.process);
    const bool open = child.output.open() || child.error.open();
    const int wait = ended ? 0 : open ? kTickMs : kExitTickMs;
    const bool moved =
        exchange_bytes(child, rest, result, options.error_tail, wait);
    if ((ended && !moved) || is_over(options, begin, result)) {
      break;
    }
  }
  finish(child.process, options, result);
  result.seconds = seconds_since(begin);
  return result;
}

std::string describe_end(const ChildResult& result) {
  if (result.timed_out) {
    return fmt::format("stopped at its time limit after {:.1f} s",
                       result.seconds);
  }
  if (result.stopped) {
    return "stopped on request";
  }
  if (result.signal != 0) {
    return fmt::format("killed by signal {} ({})", result.signal,
                       ::strsignal(result.signal));
  }
  return fmt::format("ended with exit code {}", result.exit_code);
}

struct AskedChild::Impl {
  ChildOptions options;
  Started child;
  ChildResult result;
};

AskedChild::AskedChild(const ChildOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  start(options, ErrorStream::Captured, impl_->child);
}

AskedChild::~AskedChild() {
  if (impl_->child.process > 0) {
    reap(impl_->child.process);
  }
}

void AskedChild::set_limits(std::optional<double> time_limit,
                            Monitor* monitor) {
  impl_->options.time_limit = time_limit;
  impl_->options.monitor = monitor;
}

std::optional<std::string> AskedChild::ask(std::string_view question) {
  Impl& impl = *impl_;
  if (impl.child.process < 0) {
    return std::nullopt;
  }
  const auto begin = Clock::now();
  const std::string bytes = framed(question);
  std::string_view rest = bytes;
  impl.result.output.clear();
  while (true) {
    const bool ended = has_ended(impl.child.process);
    const bool moved =
        exchange_bytes(impl.child, rest, impl.result, impl.options.error_tail,
                       ended ? 0 : kTickMs);
    if (auto answer = unframed(impl.result.output)) {
      return answer;
    }
    if ((ended && !moved) || is_over(impl.options, begin, impl.result)) {
      break;
    }
    if (!impl.child.output.open() && !ended) {
      ::poll(nullptr, 0, kExitTickMs);  // it is about to end
    }
  }
  finish(impl.child.process, impl.options, impl.result);
  impl.child.process = -1;
  impl.result.seconds = seconds_since(begin);
  return std::nullopt;
}

const ChildResult& AskedChild::end() const { return impl_->result; }

BackgroundChild::BackgroundChild(const ChildOptions& options, double grace)
    : grace_(grace) {
  ChildOptions plain = options;
  plain.memory_limit.reset();
  Started child;
  start(plain, ErrorStream::Discarded, child);
  process_ = child.process;
  output_ = child.output.release();
}

BackgroundChild::~BackgroundChild() {
  ::kill(process_, SIGTERM);
  const auto begin = Clock::now();
  while (!has_ended(process_) && seconds_since(begin) < grace_) {
    ::poll(nullptr, 0, kExitTickMs);
  }
  reap(process_);
  ::close(output_);
}

std::optional<std::string> BackgroundChild::read_line(double seconds) {
  const auto begin = Clock::now();
  while (true) {
    if (const auto end = pending_.find('\n'); end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return line;
    }
    const double left = seconds - seconds_since(begin);
    pollfd polled{output_, POLLIN, 0};
    if (left <= 0 ||
        ::poll(&polled, 1, std::max(1, static_cast<int>(1000 * left))) == 0) {
      return std::nullopt;
    }
    std::array<char, 256> buffer;
    const ssize_t got = ::read(output_, buffer.data(), buffer.size());
    if (got == 0 || (got < 0 && errno != EINTR)) {
      return std::nullopt;
    }
    pending_.append(buffer.data(),
                    static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
}

}  // namespace meniscus
