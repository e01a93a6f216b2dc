#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace railstep {

/// Identifies this program: its version and commit, or the SHA-256 of its file where the commit
/// does not say enough (no git tree, or one with changes).
std::string program_identity();

/// Names the content of a run of a sweep: SHA-256, in hexadecimal, of the program, the scene's text
/// with what was set over it, all files that it refers to, and the time from which its trace is
/// summed up. May be asked by several threads at once.
class RunKeys {
 public:
  /// @param from  s
  RunKeys(std::string program, double from);
  /// The key of a scene with its overrides. Throws InputError for a file that cannot be read; one
  /// that the scene refers to is read once.
  std::string of(const std::filesystem::path& scene, const std::vector<std::string>& overrides);
  const std::string& program() const { return program_; }

 private:
  std::string digest_of(const std::filesystem::path& file);

  std::string program_;
  double from_;
  std::mutex lock_;
  std::map<std::filesystem::path, std::string> digests_;
};

}  // namespace railstep
