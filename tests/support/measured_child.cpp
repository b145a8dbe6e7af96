#include "tests/support/measured_child.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

#include <sys/resource.h>
#include <sys/wait.h>

namespace meniscus {

namespace {

void write_all(int file, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = write(file, text.data() + done, text.size() - done);
    if (wrote < 0 && errno != EINTR) {
      return;
    }
    done += wrote > 0 ? static_cast<std::size_t>(wrote) : 0;
  }
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 65536> buffer{};
  for (;;) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(got));
    } else if (got == 0 || errno != EINTR) {
      return text;
    }
  }
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) +
         1e-6 * static_cast<double>(time.tv_usec);
}

// `child` runs in the fork, is given the pipe to write to and never returns.
MeasuredChild measure(const std::function<void(int)>& child) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    throw std::runtime_error("no pipe for a child");
  }
  std::fflush(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t process = fork();
  if (process < 0) {
    throw std::runtime_error("no child process");
  }
  if (process == 0) {
    close(ends[0]);
    child(ends[1]);
    _exit(127);
  }
  close(ends[1]);
  MeasuredChild result;
  result.output = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage usage{};
  while (wait4(process, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  const std::chrono::duration<double> wall =
      std::chrono::steady_clock::now() - start;
  result.wall_seconds = wall.count();
  result.user_seconds = seconds_of(usage.ru_utime);
  result.system_seconds = seconds_of(usage.ru_stime);
  result.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  result.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return result;
}

}  // namespace

MeasuredChild measure_forked(const std::function<std::string()>& work) {
  return measure([&](int out) {
    int code = 0;
    try {
      write_all(out, work());
    } catch (const std::exception& error) {
      write_all(out, error.what());
      code = 1;
    }
    _exit(code);
  });
}

MeasuredChild measure_program(const std::vector<std::string>& argv,
                              const std::filesystem::path& folder,
                              double time_limit) {
  std::vector<char*> arguments;
  for (const std::string& argument : argv) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  return measure([&](int out) {
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    rlimit limit{};
    limit.rlim_cur = static_cast<rlim_t>(std::ceil(time_limit));
    limit.rlim_max = limit.rlim_cur + 1;
    if (setrlimit(RLIMIT_CPU, &limit) == 0 && chdir(folder.c_str()) == 0) {
      execvp(arguments[0], arguments.data());
    }
    _exit(127);
  });
}

}  // namespace meniscus
