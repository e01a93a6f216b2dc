#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "study/reference.h"
#include "study/study_row.h"

namespace railstep {

/// The file of a study, a line of JSON each: its key, its reference, its rows. A line that was not
/// written to its end is left out.
class ResumeFile {
 public:
  /// Reads what is there. Without a name nothing is kept. Throws InputError where the file is of
  /// another key, or no such file.
  ResumeFile(std::filesystem::path file, const std::string& key);

  const std::optional<Reference>& reference() const { return reference_; }
  /// Null where it is not there.
  const SettingRow* find(const Setting& setting) const;
  void keep(const Reference& reference);
  void keep(const SettingRow& row);

 private:
  void append(const nlohmann::ordered_json& line) const;

  std::filesystem::path file_;
  std::optional<Reference> reference_;
  std::map<std::string, SettingRow> rows_;  // by words_of()
};

}  // namespace railstep
