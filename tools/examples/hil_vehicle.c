/* The vehicle of own_vehicle.c on the other side of `railstep hil --response --udp`: each packet
 * of outputs says how the track gives way in the frame to come, each answer has the wheel's force
 * in that frame, solved for with it. It uses nothing of railstep but the layouts of docs/hil.md.
 *
 * Usage: hil_vehicle HOST:PORT NAMES FRAME_S SECONDS HERTZ [explicit]
 *   NAMES    what `railstep hil --names` wrote, of a scene with one [[external_wheel]]
 *   FRAME_S  its frame; the other words are those of own_vehicle.c
 * Prints a line a frame: time, force on the wheel, rail and wheel displacement. */

#define _POSIX_C_SOURCE 200112L /* NOLINT(bugprone-reserved-identifier): POSIX wants it */
#include <netdb.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "sprung_wheel.h"

/* Inputs of a scene with one external wheel, and the last ones of its outputs. */
enum { kX, kY, kForceX, kForceY, kForceZ, kNextX, kNextY, kInputs };
enum { kForX, kForY, kFreeX, kFreeY, kFreeZ, kXX, kYX, kYY, kZX, kZY, kZZ, kAnswers };
enum { kHead = 40, kSum = 4, kMost = 65507, kPatience = 100 /* ms */ };

typedef struct {
  uint32_t inputs, outputs; /* sums of their names */
  uint32_t count;           /* of outputs */
} Layout;

typedef struct {
  int64_t frame;
  uint32_t flags;
  double answer[kAnswers];
} Outputs;

static int fail(const char* what, const char* why) {
  fprintf(stderr, "error: %s: %s\n", what, why);
  return 2;
}

/* Counts and sums of both lists of names; the names themselves are for people. */
static int read_layout(const char* file, Layout* layout) {
  FILE* const in = fopen(file, "r");
  char line[512];
  unsigned count = 0, found = 0, sum = 0;
  while (in && fgets(line, sizeof line, in)) {
    if (sscanf(line, "inputs %u %x", &count, &sum) == 2 && count == kInputs) {
      layout->inputs = sum;
      found |= 1u;
    }
    if (sscanf(line, "outputs %u %x", &count, &sum) == 2 && count > kAnswers) {
      layout->outputs = sum;
      layout->count = count;
      found |= 2u;
    }
  }
  if (in) fclose(in);
  return found == 3u;
}

static int connected(char* address) {
  char* const colon = strrchr(address, ':');
  struct addrinfo wanted, *found = NULL;
  memset(&wanted, 0, sizeof wanted);
  wanted.ai_socktype = SOCK_DGRAM;
  if (!colon) return -1;
  *colon = 0;
  if (getaddrinfo(address, colon + 1, &wanted, &found) != 0) return -1;
  int file = socket(found->ai_family, SOCK_DGRAM, 0);
  if (file >= 0 && connect(file, found->ai_addr, found->ai_addrlen) != 0) {
    close(file);
    file = -1;
  }
  freeaddrinfo(found);
  return file;
}

/* CRC-32 as in zlib, bit by bit: slow and short. */
static uint32_t crc32_of(const unsigned char* bytes, size_t count) {
  uint32_t sum = 0xFFFFFFFFu;
  for (size_t i = 0; i < count; ++i) {
    sum ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) ? 0xEDB88320u : 0u);
  }
  return ~sum;
}

static void put(unsigned char* at, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = (unsigned char)(value >> (8 * i));
}

static uint64_t get(const unsigned char* at, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= (uint64_t)at[i] << (8 * i);
  return value;
}

static double get_double(const unsigned char* at) {
  const uint64_t bits = get(at, 8);
  double value;
  memcpy(&value, &bits, 8);
  return value;
}

static void send_inputs(int file, const Layout* layout, uint64_t sequence, int64_t frame,
                        const double* value) {
  unsigned char packet[kHead + 8 * kInputs + kSum] = {'R', 'S', 'H', 'L', 1, 0, 1, 0};
  put(packet + 8, layout->inputs, 4);
  put(packet + 12, kInputs, 4);
  put(packet + 16, sequence, 8);
  put(packet + 24, (uint64_t)frame, 8);
  for (int i = 0; i < kInputs; ++i) {
    uint64_t bits;
    memcpy(&bits, &value[i], 8);
    put(packet + kHead + 8 * i, bits, 8);
  }
  put(packet + sizeof packet - kSum, crc32_of(packet, sizeof packet - kSum), 4);
  if (send(file, packet, sizeof packet, 0) < 0) return; /* it may not listen yet: it is repeated */
}

/* Whether outputs of this layout came in time. */
static int receive_outputs(int file, const Layout* layout, Outputs* out) {
  static unsigned char packet[kMost];
  struct pollfd ready = {file, POLLIN, 0};
  if (poll(&ready, 1, kPatience) <= 0) return 0;
  const size_t want = kHead + 8 * (size_t)layout->count + kSum;
  const ssize_t got = recv(file, packet, sizeof packet, 0);
  if (got < 0 || (size_t)got != want || memcmp(packet, "RSHL\1\0\2\0", 8) != 0) return 0;
  if (get(packet + 8, 4) != layout->outputs || get(packet + 12, 4) != layout->count) return 0;
  if (get(packet + want - kSum, 4) != crc32_of(packet, want - kSum)) return 0;
  out->frame = (int64_t)get(packet + 24, 8);
  out->flags = (uint32_t)get(packet + 36, 4);
  const unsigned char* const answer = packet + want - kSum - 8 * kAnswers;
  for (int i = 0; i < kAnswers; ++i) out->answer[i] = get_double(answer + 8 * i);
  return 1;
}

static int ride(int file, const Layout* layout, double frame_s, long frames, double constant,
                int explicitly) {
  const Scheme scheme = scheme_of(frame_s);
  Vehicle vehicle;
  memset(&vehicle, 0, sizeof vehicle);
  Outputs out;
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
    if (heard && out.answer[kForX] == in[kNextX]) {
      if (made == frames) break;
      const double free_z = out.answer[kFreeZ], give = out.answer[kZZ];
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
  if (!read_layout(argv[2], &layout))
    return fail(argv[2], "not the names of one external wheel with its response");
  const int file = connected(argv[1]);
  if (file < 0) return fail(argv[1], "no such address; expected HOST:PORT");
  const double frame_s = atof(argv[3]);
  const int code =
      ride(file, &layout, frame_s, lround(atof(argv[4]) / frame_s), atof(argv[5]), argc > 6);
  close(file);
  return code;
}
