#ifndef RAILSTEP_H
#define RAILSTEP_H

/* A track under traffic, or a system of bodies and beams, stepped in real time. C99, and C++17 on.
 *
 * A model is a block of bytes that `railstep condense` wrote; a run is a state of it. All memory is
 * the caller's, aligned to 8 bytes, and stays in use until the caller takes it back. Nothing here
 * allocates, throws, locks, reads a clock or does input or output, but for the texts nothing is
 * static, and every loop is capped: one thread may step one run while others step theirs of the
 * same model. SI units; x along the rail, y lateral, z up.
 *
 * A null pointer in the place of a block gives RAILSTEP_NOT_A_MODEL, in the place of a snapshot
 * RAILSTEP_NOT_A_SNAPSHOT, in the place of memory or of a result RAILSTEP_TOO_LITTLE_MEMORY. Null
 * as inputs means that the last inputs are held. The functions do not check any other pointer: a
 * model comes from railstep_load(), and a run from railstep_start(). */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define RAILSTEP_NOTHROW noexcept
extern "C" {
#else
#define RAILSTEP_NOTHROW
#endif

#define RAILSTEP_VERSION 1 /* of this interface; a larger one still has what this one has */

typedef struct railstep_model railstep_model;
typedef struct railstep_run railstep_run;

/* Result of a call. */
enum {
  RAILSTEP_OK = 0,
  RAILSTEP_MISALIGNED,        /* a block or memory does not start at a multiple of 8 bytes */
  RAILSTEP_NOT_A_MODEL,       /* a block does not begin as a model does */
  RAILSTEP_OTHER_VERSION,     /* of a model or snapshot */
  RAILSTEP_WRONG_SIZE,        /* cut short or run on */
  RAILSTEP_WRONG_SUM,         /* bytes are not those that were written */
  RAILSTEP_BAD_CONTENT,       /* a number is out of its range */
  RAILSTEP_TOO_LITTLE_MEMORY, /* see railstep_model_bytes() and railstep_run_bytes() */
  RAILSTEP_NOT_A_SNAPSHOT,    /* it does not begin as one does */
  RAILSTEP_OTHER_MODEL,       /* a snapshot of another model */
  RAILSTEP_OTHER_BYTE_ORDER,  /* a model of a machine that orders bytes the other way */
  RAILSTEP_OTHER_BITS         /* see railstep_self_check() */
};

/* Events of a frame; several can be set, the run goes on. */
enum {
  RAILSTEP_OFF_RAIL = 1,            /* a load or wheel left the rail, its force is 0 */
  RAILSTEP_CONTACT_LOST = 2,        /* a wheel stood free of its rail during the frame */
  RAILSTEP_CAP_REACHED = 4,         /* a solve ended at its cap */
  RAILSTEP_NONFINITE_STATE = 8,     /* the run is lost: state and outputs stay what they were */
  RAILSTEP_CONTACT_UNRESOLVED = 16, /* a wheel struck its rail for fewer than 10 steps */
  RAILSTEP_REDUNDANT_JOINT = 32,    /* a row of a joint hung on others */
  RAILSTEP_LARGE_TURN = 64,         /* a rail rolled so far that its linear form is off */
  RAILSTEP_NONFINITE_INPUT = 128,   /* an input was not finite: its last good value was held */
  RAILSTEP_FORCE_SATURATED = 256,   /* an input was beyond its limit, and cut to it */
  RAILSTEP_CONTACT_ILL_POSED =
      512,                   /* compliances of contacts that are not positive or not finite */
  RAILSTEP_FULL_SLIP = 1024, /* the creep of a wheel has saturated */
  RAILSTEP_BEYOND_PROFILE =
      2048 /* a wheel touches at the end of a profile, or is beside its rail */
};

/* RAILSTEP_VERSION of the library. */
int32_t railstep_version(void) RAILSTEP_NOTHROW;
/* A sentence on a result; never null. */
const char* railstep_result_text(int32_t result) RAILSTEP_NOTHROW;
/* The name of the lowest status bit that is set, as `railstep run` prints it, or "". */
const char* railstep_status_name(uint32_t status) RAILSTEP_NOTHROW;
/* Its meaning and a remedy, or "". */
const char* railstep_status_text(uint32_t status) RAILSTEP_NOTHROW;

/* Memory that a model takes beside its block. */
size_t railstep_model_bytes(void) RAILSTEP_NOTHROW;
/* Checks a block, sizes, indices and numbers, and makes a model of it. The block is not copied. */
int32_t railstep_load(const void* block, size_t block_bytes, void* memory, size_t memory_bytes,
                      const railstep_model** model) RAILSTEP_NOTHROW;

/* Simulated length of a frame, s, and how many frames the model's scene lasts. */
double railstep_frame_s(const railstep_model* model) RAILSTEP_NOTHROW;
int64_t railstep_frames(const railstep_model* model) RAILSTEP_NOTHROW;

/* Inputs are held over a frame's steps; outputs are those of its end, by the columns of a trace. */
int32_t railstep_inputs(const railstep_model* model) RAILSTEP_NOTHROW;
int32_t railstep_outputs(const railstep_model* model) RAILSTEP_NOTHROW;
/* Which one has a name, from 0; -1: none. */
int32_t railstep_find_input(const railstep_model* model, const char* name) RAILSTEP_NOTHROW;
int32_t railstep_find_output(const railstep_model* model, const char* name) RAILSTEP_NOTHROW;
/* Writes a name and a zero behind it, cut to `bytes`. Returns the length of the whole name; 0 where
 * there is no such input or output. */
size_t railstep_input_name(const railstep_model* model, int32_t index, char* name,
                           size_t bytes) RAILSTEP_NOTHROW;
size_t railstep_output_name(const railstep_model* model, int32_t index, char* name,
                            size_t bytes) RAILSTEP_NOTHROW;

/* Memory of a run: its state, scratch and outputs. */
size_t railstep_run_bytes(const railstep_model* model) RAILSTEP_NOTHROW;
/* A run at the model's start. */
int32_t railstep_start(const railstep_model* model, void* memory, size_t bytes,
                       railstep_run** run) RAILSTEP_NOTHROW;
/* Back to the start; what was latched is cleared. */
void railstep_reset(railstep_run* run) RAILSTEP_NOTHROW;

/* Steps the model through the check that stands in its block, from the start and back to it, and
 * tells whether every bit is as where it was written: RAILSTEP_OK or RAILSTEP_OTHER_BITS. */
int32_t railstep_self_check(railstep_run* run) RAILSTEP_NOTHROW;

/* One frame. inputs: [railstep_inputs()], or null: as they are held. Returns the status bits of the
 * frame. Three of them stay set once a frame has met them: nonfinite_input, nonfinite_state and
 * force_saturated. */
uint32_t railstep_step(railstep_run* run, const double* inputs) RAILSTEP_NOTHROW;
/* Outputs of the last frame, or of the start. outputs: [railstep_outputs()] overwritten. */
void railstep_read(const railstep_run* run, double* outputs) RAILSTEP_NOTHROW;
/* Steps made since the start, and their time, s. */
int64_t railstep_steps(const railstep_run* run) RAILSTEP_NOTHROW;
double railstep_time_s(const railstep_run* run) RAILSTEP_NOTHROW;
/* Hash of the state's bits: equal states have equal hashes. */
uint64_t railstep_hash(const railstep_run* run) RAILSTEP_NOTHROW;

/* Wheels of a vehicle outside the model ([[external_wheel]] of a scene). The response of
 * the rail under them in the next frame: with 3 n + d for direction d (x, y, z) of wheel n, their
 * points will be displaced by free_motion + compliance * forces under forces on the rail, to
 * rounding. The run is not changed. inputs: places as the frame will have them, or null: as they
 * are held; the forces among them are not looked at. free_motion: [3 n], m; compliance: [3 n][3 n],
 * symmetric, m/N; both 0 for a wheel off the rail. Returns what was met. */
int32_t railstep_external_wheels(const railstep_model* model) RAILSTEP_NOTHROW;
uint32_t railstep_response(railstep_run* run, const double* inputs, double* free_motion,
                           double* compliance) RAILSTEP_NOTHROW;

/* A run's state in bytes, the same on every machine, and back to the bit. */
size_t railstep_snapshot_bytes(const railstep_model* model) RAILSTEP_NOTHROW;
void railstep_save(const railstep_run* run, void* snapshot) RAILSTEP_NOTHROW;
int32_t railstep_restore(railstep_run* run, const void* snapshot, size_t bytes) RAILSTEP_NOTHROW;

#ifdef __cplusplus
}
#endif

#endif
