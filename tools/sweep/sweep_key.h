#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace railstep {

/// What this program is: its version and commit, and where that does not tell (a tree with changes,
/// or none) the SHA-256 of its file.
std::string program_identity();

/// Names what a run of a sweep is made of: SHA-256, in hexadecimal, of the program, the scene's
/// text with what was set over it, all files that it refers to, and the time from which its trace
/// is summed up. May be asked by several threads at once.
class RunKeys {
 public:
  /// @param from  s
  RunKeys(std::string program, double from);
  /// Of a scene with what is set over it. Throws InputError for a file that cannot be read; one
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
