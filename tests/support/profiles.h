#pragma once
#include <array>
#include <filesystem>
#include <string>

#include "section/profile.h"

namespace railstep {

inline constexpr std::array<const char*, 6> kProfiles = {"60e1", "54e1",  "56e1",
                                                         "49e1", "136re", "115re"};

inline std::filesystem::path profile_file(const std::string& name) {
  return std::filesystem::path(RAILSTEP_SOURCE) / "config" / "profiles" / (name + ".toml");
}

}  // namespace railstep
