#ifndef LOADED_MODEL_H
#define LOADED_MODEL_H

/* A model of `railstep condense` and a run of it, through the C interface. */

#include <stdio.h>
#include <stdlib.h>

#include "railstep.h"

typedef struct {
  void *block, *place, *memory; /* of the caller, until free_model() */
  const railstep_model* model;
  railstep_run* run;
} Loaded;

static void* whole_file(const char* name, size_t* bytes) {
  FILE* const file = fopen(name, "rb");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  fseek(file, 0, SEEK_SET);
  void* const block = size > 0 ? malloc((size_t)size) : NULL;
  *bytes = block ? fread(block, 1, (size_t)size, file) : 0;
  fclose(file);
  return block;
}

static void free_model(Loaded* loaded) {
  free(loaded->memory);
  free(loaded->place);
  free(loaded->block);
}

/* Why a model cannot be run; NULL: it can. */
static const char* load_model(const char* file, Loaded* loaded) {
  size_t bytes = 0;
  *loaded = (Loaded){whole_file(file, &bytes), malloc(railstep_model_bytes()), NULL, NULL, NULL};
  if (!loaded->block) return "cannot be read";
  int32_t result =
      railstep_load(loaded->block, bytes, loaded->place, railstep_model_bytes(), &loaded->model);
  if (result != RAILSTEP_OK) return railstep_result_text(result);
  const size_t size = railstep_run_bytes(loaded->model);
  loaded->memory = malloc(size);
  result = railstep_start(loaded->model, loaded->memory, size, &loaded->run);
  return result == RAILSTEP_OK ? NULL : railstep_result_text(result);
}

#endif
