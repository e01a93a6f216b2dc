#include <inttypes.h>
#include <railstep.h>
#include <stdio.h>
#include <stdlib.h>

/* Steps a model file for a number of frames and prints the state's hash. */
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  FILE* const file = fopen(argv[1], "rb");
  if (!file) return 2;
  static double block[1 << 21];
  const size_t bytes = fread(block, 1, sizeof block, file);
  fclose(file);
  const railstep_model* model = NULL;
  railstep_run* run = NULL;
  if (railstep_load(block, bytes, malloc(railstep_model_bytes()), railstep_model_bytes(), &model) ||
      railstep_start(model, malloc(railstep_run_bytes(model)), railstep_run_bytes(model), &run))
    return 1;
  for (int n = atoi(argv[2]); n > 0; --n) railstep_step(run, NULL);
  printf("%016" PRIx64 "\n", railstep_hash(run));
  return 0;
}
