#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "text/message.h"

namespace railstep {

/// {"id": ..., "text": ...}
inline nlohmann::ordered_json to_json(const Message& message) {
  return {{"id", message.id}, {"text", message.text}};
}
inline nlohmann::ordered_json to_json(const std::vector<Message>& messages) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Message& message : messages) all.push_back(to_json(message));
  return all;
}

}  // namespace railstep
