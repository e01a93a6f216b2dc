/* Steps a model that `railstep condense --emit-c` wrote through its scene, without files, heap or
 * an operating system, and prints the state's hash. C99 and C++17. Compiled with
 *   MODEL_FILE  the emitted file, in quotes
 *   MODEL       its name
 * and on a machine without a system beside board.c. */
#include "railstep.h"

#include MODEL_FILE
#include "say.h"

#define JOINED(a, b) a##b
#define BYTES_OF(name) JOINED(name, _bytes)

/* Doubles, so that the memory is aligned. */
static double model_memory[1 << 15], run_memory[1 << 16];

static int fail(const char* why) {
  say("error: ");
  say(why);
  say("\n");
  return 1;
}

int main(void) {
  const railstep_model* model = NULL;
  railstep_run* run = NULL;
  char hash[18];
  int64_t frames, i;
  uint64_t value;
  int digit;
  int32_t result =
      railstep_load(&MODEL, BYTES_OF(MODEL), model_memory, sizeof model_memory, &model);
  if (result == RAILSTEP_OK) result = railstep_start(model, run_memory, sizeof run_memory, &run);
  if (result == RAILSTEP_OK) result = railstep_self_check(run);
  if (result != RAILSTEP_OK) return fail(railstep_result_text(result));
  frames = railstep_frames(model);
  for (i = 0; i < frames; ++i) (void)railstep_step(run, NULL);
  value = railstep_hash(run);
  for (digit = 0; digit < 16; ++digit) hash[digit] = "0123456789abcdef"[value >> (60 - 4 * digit) & 15];
  hash[16] = '\n';
  hash[17] = 0;
  say(hash);
  return 0;
}
