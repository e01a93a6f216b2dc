#include "study/resume.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "offline/math/refuse.h"
#include "text/read.h"
#include "text/write.h"

namespace railstep {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Reference& reference) {
  return {{"how", reference.how},
          {"error", reference.error},
          {"columns", reference.trace.columns},
          {"values", reference.trace.values}};
}

Reference reference_from(const Json& json) {
  return {{json.at("columns").get<std::vector<std::string>>(),
           json.at("values").get<std::vector<double>>()},
          json.at("how").get<std::string>(),
          json.at("error").get<double>()};
}

}  // namespace

ResumeFile::ResumeFile(std::filesystem::path file, const std::string& key)
    : file_(std::move(file)) {
  if (file_.empty()) return;
  if (!std::filesystem::exists(file_)) {
    write_file(file_, Json{{"study", key}}.dump() + "\n");
    return;
  }
  std::ifstream in(file_);
  std::string text, whole;
  std::getline(in, text);
  const Json first = Json::parse(text, nullptr, false);
  if (first.is_discarded() || !first.is_object() || !first.contains("study"))
    throw InputError(
        "E-STUDY-09",
        fmt::format(
            "{}: this is not a file of a study; expected one that --resume wrote, or a new name",
            file_.string()));
  if (first.at("study") != key)
    throw InputError("E-STUDY-10",
                     fmt::format("{}: this file is of another scene, question or program; expected "
                                 "one of the same study, or a new name",
                                 file_.string()));
  whole = text + "\n";
  while (std::getline(in, text)) {
    const Json line = Json::parse(text, nullptr, false);
    if (line.is_discarded()) continue;  // cut off
    whole += text + "\n";
    if (line.contains("reference")) reference_ = reference_from(line.at("reference"));
    if (!line.contains("row")) continue;
    SettingRow row = row_from_json(line.at("row"));
    rows_.insert_or_assign(words_of(row.setting), std::move(row));
  }
  write_file(file_, whole);  // without what was cut off, so that lines can follow
}

const SettingRow* ResumeFile::find(const Setting& setting) const {
  const auto found = rows_.find(words_of(setting));
  return found == rows_.end() ? nullptr : &found->second;
}

void ResumeFile::append(const Json& line) const {
  if (file_.empty()) return;
  std::ofstream out(file_, std::ios::app);
  out << line.dump() << std::endl;
  if (!out)
    fail("E-STUDY-11",
         fmt::format("{}: the file cannot be written: {}", file_.string(), std::strerror(errno)));
}

void ResumeFile::keep(const Reference& reference) { append({{"reference", to_json(reference)}}); }
void ResumeFile::keep(const SettingRow& row) { append({{"row", railstep::to_json(row)}}); }

}  // namespace railstep
