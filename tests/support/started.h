#pragma once
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>

#include "support/program.h"

namespace railstep {

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
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing behind
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
    wait_until([&] { return !runs(); }, "the end of the program");
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    return {code, text_of(file("out")), text_of(file("err"))};
  }

 private:
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
