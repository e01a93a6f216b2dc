/* The vehicle of own_vehicle.c on the other side of `railstep hil --response --udp`: each packet
 * of outputs says how the track gives way in the frame to come, each answer has the wheel's force
 * in that frame, solved for with it. It uses nothing of railstep but the layouts of docs/hil.md.
 *
 * Usage: hil_vehicle HOST:PORT NAMES FRAME_S SECONDS HERTZ [explicit]
 *   NAMES    what `railstep hil --names` wrote, of a scene with one [[external_wheel]]
 *   FRAME_S  its frame; the other words are those of own_vehicle.c
 * Prints a line a frame: time, force on the wheel, rail and wheel displacement. */

#define _POSIX_C_SOURCE 200112L /* NOLINT(bugprone-reserved-identifier): POSIX wants it */
#include "hil_packets.h"
#include "sprung_wheel.h"

/* Inputs of a scene with one external wheel, and the last ones of its outputs. */
enum { kX, kY, kForceX, kForceY, kForceZ, kNextX, kNextY, kInputs };
enum { kForX, kForY, kFreeX, kFreeY, kFreeZ, kXX, kYX, kYY, kZX, kZY, kZZ, kAnswers };

static int ride(int file, const Layout* layout, double frame_s, long frames, double constant,
                int explicitly) {
  const Scheme scheme = scheme_of(frame_s);
  Vehicle vehicle;
  memset(&vehicle, 0, sizeof vehicle);
  static Outputs out;
  const double* const answer = out.value + (layout->output_count - kAnswers);
  double in[kInputs] = {0}, rail = 0.0;
  in[kNextX] = kStart + kSpeed * frame_s;
  uint64_t sequence = 0;
  int64_t next = -1; /* frame that the inputs are for: at first any */
  long made = 0, missed = 0, silent = 0;
  printf("time_s,force_n,rail_m,wheel_m\n");
  send_inputs(file, layout, ++sequence, next, in);
  while (silent < 100) {
    const int heard = receive_outputs(file, layout, &out);
    silent = heard ? 0 : silent + 1;
    if (heard && (out.flags & 1u)) break; /* the run has ended */
    if (heard && answer[kForX] == in[kNextX]) {
      if (made == frames) break;
      const double free_z = answer[kFreeZ], give = answer[kZZ];
      const double force = explicitly ? hertz(constant, rail - vehicle.u[kWheel])
                                      : closed_contact(&scheme, &vehicle, constant, free_z, give);
      vehicle = moved(&scheme, &vehicle, force);
      rail = free_z - give * force;
      ++made;
      printf("%.17g,%.17g,%.17g,%.17g\n", (double)made * frame_s, force, rail, vehicle.u[kWheel]);
      if (!(fabs(force) < 1e12)) return 1;
      in[kX] = in[kNextX];
      in[kForceZ] = -force;
      in[kNextX] = kStart + kSpeed * ((double)(made + 1) * frame_s);
    } else if (heard && made > 0 && out.frame >= next) {
      ++missed; /* a frame was made without what was sent for it: the vehicle is late by one */
    }
    if (heard) next = out.frame + 1;
    send_inputs(file, layout, ++sequence, next, in);
  }
  fprintf(stderr, "frames %ld, missed %ld\n", made, missed);
  return made == frames && missed == 0 ? 0 : 1;
}

int main(int argc, char** argv) {
  if (argc < 6)
    return fail("usage", "hil_vehicle HOST:PORT NAMES FRAME_S SECONDS HERTZ [explicit]");
  Layout layout;
  if (!read_layout(argv[2], &layout) || layout.input_count != kInputs ||
      layout.output_count <= kAnswers)
    return fail(argv[2], "not the names of one external wheel with its response");
  const int file = connected(argv[1]);
  if (file < 0) return fail(argv[1], "no such address; expected HOST:PORT");
  const double frame_s = atof(argv[3]);
  const int code =
      ride(file, &layout, frame_s, lround(atof(argv[4]) / frame_s), atof(argv[5]), argc > 6);
  close(file);
  return code;
}
