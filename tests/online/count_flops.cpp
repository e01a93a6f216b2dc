// Steps a model file with a build of the online library in which every `double` counts its
// arithmetic (counted/counted.h). Fails where a frame takes more flops than the model states.
#include <string_view>

#include "model_file.h"
#include "online/step/step.h"

using namespace railstep;

int main(int count, char** text) {
  const long frames = count >= 3 ? std::strtol(text[2], nullptr, 10) : 0;
  const bool caps = count == 4 && std::string_view(text[3]) == "caps";
  if (frames < 1 || count > 4 || (count == 4 && !caps)) {
    std::fputs(
        "usage: count_flops MODEL FRAMES [caps]\n"
        "prints the fewest and the most flops of a frame, and those that the model states; caps:\n"
        "with all iterations of guides and systems at their caps.\n",
        stderr);
    return 2;
  }
  ModelFile file(text[1]);
  if (file.model == nullptr) return 2;
  if (caps) file.go_to_caps();
  Outputs outputs{};
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = 0;
  for (long frame = 0; frame < frames; ++frame) {
    counted::flops = 0;
    (void)advance_frame(*file.model, file.state, file.workspace, outputs);
    if (counted::flops < least) least = counted::flops;
    if (counted::flops > most) most = counted::flops;
  }
  const std::int64_t stated = file.model->cost.flops;
  std::printf("%" PRId64 " %" PRId64 " %" PRId64 "\n", least, most, stated);
  if (most <= stated) return 0;
  std::fprintf(stderr, "error: %s: a frame takes more flops than the model states\n", text[1]);
  return 1;
}
