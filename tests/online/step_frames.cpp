// Steps a model file and does nothing else, so that a tool that counts what the calls of
// advance_frame() execute sees only frames.
#include <cinttypes>
#include <cstdlib>
#include <string_view>

#include "model_file.h"
#include "online/beam/kernels.h"
#include "online/step/step.h"

using namespace railstep;

int main(int count, char** text) {
  const long frames = count >= 3 ? std::strtol(text[2], nullptr, 10) : 0;
  const bool caps = count == 4 && std::string_view(text[3]) == "caps";
  if (frames < 1 || count > 4 || (count == 4 && !caps)) {
    std::fputs(
        "usage: step_frames MODEL FRAMES [caps]\n"
        "prints the instructions and the bytes of a frame that the model states; caps: with all\n"
        "iterations of guides and systems at their caps.\n",
        stderr);
    return 2;
  }
  ModelFile file(text[1]);
  if (file.model == nullptr) return 2;
  if (caps) file.go_to_caps();
  use_kernels(&kBaseKernels);  // a model states the instructions of these kernels
  Outputs outputs{};
  for (long frame = 0; frame < frames; ++frame)
    (void)advance_frame(*file.model, file.state, file.workspace, outputs);
  std::printf("%" PRId64 " %" PRId64 "\n", file.model->cost.instructions, file.model->cost.bytes);
  return 0;
}
