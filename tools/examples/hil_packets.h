#ifndef HIL_PACKETS_H
#define HIL_PACKETS_H

/* One end of `railstep hil --udp` for programs in C: the layouts of docs/hil.md, and nothing else
 * of railstep. */

#include <netdb.h>
#include <poll.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { kHead = 40, kSum = 4, kMost = 65507, kPatience = 100 /* ms */ };
enum { kMostInputs = 64, kMostOutputs = (kMost - kHead - kSum) / 8 };

/* How many inputs and outputs there are, and the sums of their names. */
typedef struct {
  uint32_t inputs, input_count, outputs, output_count;
} Layout;

typedef struct {
  int64_t frame;
  uint32_t flags; /* 1: the run has ended */
  double value[kMostOutputs];
} Outputs;

static int fail(const char* what, const char* why) {
  fprintf(stderr, "error: %s: %s\n", what, why);
  return 2;
}

/* Counts and sums of both lists in the file of `railstep hil --names`. */
static int read_layout(const char* file, Layout* layout) {
  FILE* const in = fopen(file, "r");
  char line[512];
  unsigned count = 0, sum = 0;
  memset(layout, 0, sizeof *layout);
  while (in && fgets(line, sizeof line, in)) {
    if (sscanf(line, "inputs %u %x", &count, &sum) == 2) {
      layout->inputs = sum;
      layout->input_count = count;
    }
    if (sscanf(line, "outputs %u %x", &count, &sum) == 2) {
      layout->outputs = sum;
      layout->output_count = count;
    }
  }
  if (in) fclose(in);
  return layout->input_count <= kMostInputs && layout->output_count > 0 &&
         layout->output_count <= kMostOutputs;
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

/* @param value  [input_count] */
static void send_inputs(int file, const Layout* layout, uint64_t sequence, int64_t frame,
                        const double* value) {
  unsigned char packet[kHead + 8 * kMostInputs + kSum] = {'R', 'S', 'H', 'L', 1, 0, 1, 0};
  const size_t size = kHead + 8 * (size_t)layout->input_count + kSum;
  put(packet + 8, layout->inputs, 4);
  put(packet + 12, layout->input_count, 4);
  put(packet + 16, sequence, 8);
  put(packet + 24, (uint64_t)frame, 8);
  for (uint32_t i = 0; i < layout->input_count; ++i) {
    uint64_t bits;
    memcpy(&bits, &value[i], 8);
    put(packet + kHead + 8 * i, bits, 8);
  }
  put(packet + size - kSum, crc32_of(packet, size - kSum), 4);
  if (send(file, packet, size, 0) < 0) return; /* it may not listen yet: it is repeated */
}

/* Whether outputs of this layout came in time. */
static int receive_outputs(int file, const Layout* layout, Outputs* out) {
  static unsigned char packet[kMost];
  struct pollfd ready = {file, POLLIN, 0};
  if (poll(&ready, 1, kPatience) <= 0) return 0;
  const size_t want = kHead + 8 * (size_t)layout->output_count + kSum;
  const ssize_t got = recv(file, packet, sizeof packet, 0);
  if (got < 0 || (size_t)got != want || memcmp(packet, "RSHL\1\0\2\0", 8) != 0) return 0;
  if (get(packet + 8, 4) != layout->outputs || get(packet + 12, 4) != layout->output_count)
    return 0;
  if (get(packet + want - kSum, 4) != crc32_of(packet, want - kSum)) return 0;
  out->frame = (int64_t)get(packet + 24, 8);
  out->flags = (uint32_t)get(packet + 36, 4);
  for (uint32_t i = 0; i < layout->output_count; ++i)
    out->value[i] = get_double(packet + kHead + 8 * i);
  return 1;
}

#endif
