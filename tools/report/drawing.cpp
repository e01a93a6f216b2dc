#include "report/drawing.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "offline/math/refuse.h"

namespace railstep {
namespace {

/// A file of its own in the temporary folder, gone at the end of the scope.
class ScriptFile {
 public:
  explicit ScriptFile(const std::string& text)
      : name_((std::filesystem::temp_directory_path() / "railstep-XXXXXX").string()) {
    const int descriptor = mkstemp(name_.data());
    if (descriptor < 0)
      fail("E-REPORT-01",
           "no temporary file for gnuplot can be made; expected room and rights in the folder of "
           "temporary files");
    close(descriptor);
    std::FILE* out = std::fopen(name_.c_str(), "wb");
    if (out) std::fwrite(text.data(), 1, text.size(), out);
    if (!out || std::fclose(out) != 0)
      fail("E-REPORT-02",
           "the temporary file for gnuplot cannot be written; expected room in the folder of "
           "temporary files");
  }
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;
  ~ScriptFile() { std::remove(name_.c_str()); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace

void need_gnuplot() {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    fail("E-REPORT-03",
         "--report draws with gnuplot, which is not installed; install it, or leave out --report");
}

std::string drawn(const std::string& script) {
  const ScriptFile file(script);
  std::FILE* in = popen(fmt::format("gnuplot '{}'", file.name()).c_str(), "r");
  if (!in) fail("E-REPORT-04", "gnuplot, which draws the report, cannot be started");
  std::string svg;
  char buffer[4096];
  for (std::size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, in)) > 0;)
    svg.append(buffer, got);
  const std::size_t start = svg.find("<svg");
  if (pclose(in) != 0 || start == std::string::npos)
    fail("E-REPORT-05", "gnuplot did not draw the report");
  return svg.substr(start);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace railstep
