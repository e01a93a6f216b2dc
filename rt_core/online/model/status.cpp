#include "online/model/status.h"

namespace railstep {

const StatusText* text_of(Status status) noexcept {
  for (const StatusText& text : kStatusTexts)
    if (has(status, text.bit)) return &text;
  return nullptr;
}

}  // namespace railstep
