#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>

#include "support/program.h"

namespace railstep {

/// Longest time that a test waits, however busy the machine is.
inline constexpr std::chrono::seconds kPatience{120};

/// A program that runs beside the test, in a folder of its own. Every wait for it is bounded.
class Started {
 public:
  explicit Started(const std::string& words, const std::string& program = RAILSTEP_PROGRAM)
      : folder_(fresh_folder("started_" + std::to_string(++count()))) {
    const std::string command =
        "exec '" + program + "' " + words + " >'" + file("out") + "' 2>'" + file("err") + "'";
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;
  ~Started() {
    if (runs()) {
      kill(pid_, SIGKILL);
      waitpid(pid_, &status_, 0);
    }
    std::filesystem::remove_all(folder_);
  }

  bool runs() { return !ended_ && !(ended_ = waitpid(pid_, &status_, WNOHANG) != 0); }
  void signal(int number) const { kill(pid_, number); }

  /// Waits until the program has done it. Fails the test if it ends before or takes too long.
  void await(const std::function<bool()>& done) {
    const bool was = waited([&] { return done() || !runs(); }) && done();
    if (was) return;
    const bool alive = runs();
    if (alive) kill(pid_, SIGKILL);
    FAIL((alive ? "the program did not do it: " : "the program ended before: ")
         << text_of(file("err")));
  }
  void await(const std::filesystem::path& file) {
    await([&] { return std::filesystem::exists(file); });
  }
  /// Waits for the program's end.
  /// @returns code -N if signal N ended it
  Ran end() {
    if (!waited([&] { return !runs(); })) FAIL("the program did not end");
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    return {code, text_of(file("out")), text_of(file("err"))};
  }

 private:
  static bool waited(const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      usleep(1000);
    }
    return true;
  }
  static int& count() {
    static int of_process = 0;
    return of_process;
  }
  std::string file(const char* name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace railstep
