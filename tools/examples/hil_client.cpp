// An example of what talks to `railstep hil`: it sends inputs and prints outputs, over UDP or
// shared memory. It uses nothing of railstep but the layouts of docs/hil.md, so that it can be
// taken as it is, and so that the layouts are written down twice.
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace {

using Names = std::vector<std::string>;

struct Options {
  std::string udp, shm, names;
  std::vector<std::string> inputs;  // NAME=VALUE or INDEX=VALUE
  long long frames = -1;            // outputs to take; -1: until the run ends
  double seconds = 10.;             // without outputs before it gives up
};

struct Outputs {
  long long frame = -1;
  std::uint32_t status = 0, flags = 0;
  std::vector<double> value;
};

[[noreturn]] void fail(const std::string& sentence) {
  std::fprintf(stderr, "error: %s\n", sentence.c_str());
  std::exit(2);
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The values to send, from what the options say of inputs by name or by index.
std::vector<double> inputs_of(const Options& o, const Names& names) {
  std::vector<double> value(names.size(), 0.);
  for (const std::string& given : o.inputs) {
    const std::size_t equals = given.find('=');
    if (equals == std::string::npos) fail("--input " + given + ": expected NAME=VALUE");
    const std::string name = given.substr(0, equals);
    std::size_t at = 0;
    while (at < names.size() && names[at] != name && std::to_string(at) != name) ++at;
    if (at == names.size()) fail("--input " + given + ": the model has no such input");
    value[at] = std::strtod(given.c_str() + equals + 1, nullptr);
  }
  return value;
}

void print_outputs(const Outputs& o, const Names& names) {
  std::printf("frame %lld, status %u, flags %u\n", o.frame, o.status, o.flags);
  for (std::size_t i = 0; i < names.size(); ++i)
    std::printf("  %-32s %.9g\n", names[i].c_str(), o.value[i]);
}

/// The answer of `railstep hil --names`: count, sum and names of the inputs and of the outputs.
struct Layout {
  Names inputs, outputs;
  std::uint32_t inputs_sum = 0, outputs_sum = 0;
};

Layout read_names(const std::string& file) {
  std::ifstream in(file);
  Layout read;
  const auto part = [&](const char* kind, Names& names, std::uint32_t& sum) {
    std::string word, line;
    std::size_t count = 0;
    if (!(in >> word >> count >> std::hex >> sum >> std::dec) || word != kind)
      fail("--names " + file + ": not what `railstep hil --names` writes");
    std::getline(in, line);
    while (names.size() < count && std::getline(in, line)) names.push_back(line);
  };
  part("inputs", read.inputs, read.inputs_sum);
  part("outputs", read.outputs, read.outputs_sum);
  return read;
}

// ---- UDP ----

constexpr std::size_t kHead = 40, kSum = 4;
constexpr unsigned char kMagic[4] = {'R', 'S', 'H', 'L'};

/// CRC-32 as in zlib, bit by bit: slow and short.
std::uint32_t crc32_of(const unsigned char* bytes, std::size_t count) {
  std::uint32_t sum = 0xFFFFFFFFu;
  for (std::size_t i = 0; i < count; ++i) {
    sum ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) ? 0xEDB88320u : 0u);
  }
  return ~sum;
}

void put(unsigned char* at, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = static_cast<unsigned char>(value >> (8 * i));
}

std::uint64_t get(const unsigned char* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= static_cast<std::uint64_t>(at[i]) << (8 * i);
  return value;
}

std::vector<unsigned char> inputs_packet(const Layout& layout, const std::vector<double>& value,
                                         std::uint64_t sequence, long long frame) {
  std::vector<unsigned char> packet(kHead + 8 * value.size() + kSum, 0);
  unsigned char* const at = packet.data();
  std::memcpy(at, kMagic, sizeof kMagic);
  put(at + 4, 1, 2);  // version
  put(at + 6, 1, 2);  // kind: inputs
  put(at + 8, layout.inputs_sum, 4);
  put(at + 12, value.size(), 4);
  put(at + 16, sequence, 8);
  put(at + 24, static_cast<std::uint64_t>(frame), 8);
  for (std::size_t i = 0; i < value.size(); ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value[i], 8);
    put(at + kHead + 8 * i, bits, 8);
  }
  put(at + packet.size() - kSum, crc32_of(at, packet.size() - kSum), 4);
  return packet;
}

/// Whether these bytes are outputs of this layout.
bool read_outputs(const unsigned char* at, std::size_t size, const Layout& layout, Outputs& out,
                  std::uint64_t& sequence) {
  const std::size_t count = layout.outputs.size();
  if (size != kHead + 8 * count + kSum || std::memcmp(at, kMagic, sizeof kMagic) != 0) return false;
  if (get(at + 4, 2) != 1 || get(at + 6, 2) != 2 || get(at + 8, 4) != layout.outputs_sum ||
      get(at + 12, 4) != count || get(at + size - kSum, 4) != crc32_of(at, size - kSum))
    return false;
  sequence = get(at + 16, 8);
  out.frame = static_cast<long long>(get(at + 24, 8));
  out.status = static_cast<std::uint32_t>(get(at + 32, 4));
  out.flags = static_cast<std::uint32_t>(get(at + 36, 4));
  out.value.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t bits = get(at + kHead + 8 * i, 8);
    std::memcpy(&out.value[i], &bits, 8);
  }
  return true;
}

int connected_socket(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) fail("--udp " + address + ": expected HOST:PORT");
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_DGRAM;
  std::string host = address.substr(0, colon);
  if (host.size() > 2 && host.front() == '[') host = host.substr(1, host.size() - 2);
  if (getaddrinfo(host.c_str(), address.c_str() + colon + 1, &wanted, &found) != 0)
    fail("--udp " + address + ": no such address");
  const int socket = ::socket(found->ai_family, SOCK_DGRAM, 0);
  if (socket < 0 || connect(socket, found->ai_addr, found->ai_addrlen) != 0)
    fail("--udp " + address + ": " + std::strerror(errno));
  freeaddrinfo(found);
  return socket;
}

/// Answers every frame's outputs with the inputs of the next one.
int talk_by_udp(const Options& o) {
  const Layout layout = read_names(o.names);
  const std::vector<double> value = inputs_of(o, layout.inputs);
  const int socket = connected_socket(o.udp);
  std::vector<unsigned char> bytes(65536);
  Outputs out;
  std::uint64_t sent = 0, sequence = 0, newest = 0;
  long long received = 0, missed = 0;
  const auto give = [&](long long frame) {
    const auto packet = inputs_packet(layout, value, ++sent, frame);
    static_cast<void>(send(socket, packet.data(), packet.size(), 0));  // it may not listen yet
  };
  give(-1);  // for any frame: the first outputs come in answer to it
  for (double heard = seconds_now(); seconds_now() - heard < o.seconds && received != o.frames;) {
    pollfd ready{socket, POLLIN, 0};
    if (poll(&ready, 1, 100) <= 0) {
      give(-1);
      continue;
    }
    const ssize_t got = recv(socket, bytes.data(), bytes.size(), 0);
    if (got < 0 ||
        !read_outputs(bytes.data(), static_cast<std::size_t>(got), layout, out, sequence))
      continue;
    heard = seconds_now();
    ++received;
    if (sequence > newest + 1) missed += static_cast<long long>(sequence - newest - 1);
    newest = sequence;
    if ((out.flags & 1u) != 0) break;  // the run has ended
    give(out.frame + 1);
  }
  close(socket);
  if (received > 0) print_outputs(out, layout.outputs);
  std::printf("sent %llu, received %lld, missed %lld\n", static_cast<unsigned long long>(sent),
              received, missed);
  return received > 0 ? 0 : 1;
}

// ---- shared memory ----

using Word = std::atomic<std::uint64_t>;

/// One writer: the lock is odd while the words change.
void write_block(Word* block, const std::vector<std::uint64_t>& words) {
  const std::uint64_t odd = block[0].load(std::memory_order_relaxed) | 1u;
  block[0].store(odd, std::memory_order_relaxed);
  for (std::size_t i = 0; i < words.size(); ++i)
    block[1 + i].store(words[i], std::memory_order_release);
  block[0].store(odd + 1, std::memory_order_release);
}

/// Any number of readers: words between two equal, even readings of the lock are whole.
bool read_block(const Word* block, std::vector<std::uint64_t>& words) {
  const std::uint64_t before = block[0].load(std::memory_order_acquire);
  if ((before & 1u) != 0 || before == 0) return false;
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i] = block[1 + i].load(std::memory_order_acquire);
  return block[0].load(std::memory_order_relaxed) == before;
}

Word* shared_memory(const std::string& name, double seconds, std::size_t& bytes) {
  for (const double start = seconds_now(); seconds_now() - start < seconds; usleep(1000)) {
    const int file = shm_open(("/" + name).c_str(), O_RDWR, 0);
    if (file < 0) continue;
    struct stat about {};
    fstat(file, &about);
    bytes = static_cast<std::size_t>(about.st_size);
    void* const memory =
        bytes < 64 ? MAP_FAILED : mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (memory == MAP_FAILED) continue;
    Word* const words = static_cast<Word*>(memory);
    if (words[1].load(std::memory_order_acquire) == 1) return words;
    munmap(memory, bytes);
  }
  fail("--shm " + name + ": no run has it");
}

/// Splits the names that stand in the memory, inputs first.
void split_names(const char* text, std::size_t bytes, std::size_t inputs, Layout& layout) {
  std::string name;
  for (std::size_t i = 0; i < bytes; ++i) {
    if (text[i] != '\n') {
      name += text[i];
      continue;
    }
    (layout.inputs.size() < inputs ? layout.inputs : layout.outputs).push_back(name);
    name.clear();
  }
}

int talk_by_memory(const Options& o) {
  std::size_t bytes = 0;
  Word* const word = shared_memory(o.shm, o.seconds, bytes);
  const auto* const text = reinterpret_cast<const char*>(word);
  if (std::memcmp(text, "railshm1", 8) != 0) fail("--shm " + o.shm + ": not of railstep");
  Layout layout;
  split_names(text + word[6].load(), word[7].load(), word[2].load(), layout);
  Word* const in = word + word[4].load() / 8;
  const Word* const from = word + word[5].load() / 8;
  const std::vector<double> value = inputs_of(o, layout.inputs);
  std::vector<std::uint64_t> words(3 + value.size(), 0), seen(3 + layout.outputs.size(), 0);
  Outputs out;
  out.value.resize(layout.outputs.size());
  std::uint64_t newest = 0;
  long long received = 0;
  const auto give = [&](long long frame) {
    ++words[0];
    words[1] = static_cast<std::uint64_t>(frame);
    if (!value.empty()) std::memcpy(&words[3], value.data(), 8 * value.size());
    write_block(in, words);
  };
  give(-1);
  for (double heard = seconds_now(); seconds_now() - heard < o.seconds && received != o.frames;) {
    if (!read_block(from, seen) || seen[0] == newest) {
      usleep(50);
      continue;
    }
    heard = seconds_now();
    newest = seen[0];
    ++received;
    out.frame = static_cast<long long>(seen[1]);
    out.status = static_cast<std::uint32_t>(seen[2]);
    out.flags = static_cast<std::uint32_t>(seen[2] >> 32);
    std::memcpy(out.value.data(), &seen[3], 8 * out.value.size());
    if ((out.flags & 1u) != 0) break;
    give(out.frame + 1);
  }
  if (received > 0) print_outputs(out, layout.outputs);
  std::printf("received %lld\n", received);
  munmap(word, bytes);
  return received > 0 ? 0 : 1;
}

Options read_options(int argc, char** argv) {
  Options o;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--udp") o.udp = value;
    if (key == "--shm") o.shm = value;
    if (key == "--names") o.names = value;
    if (key == "--input") o.inputs.push_back(value);
    if (key == "--frames") o.frames = std::atoll(value.c_str());
    if (key == "--seconds") o.seconds = std::atof(value.c_str());
  }
  return o;
}

}  // namespace

int main(int argc, char** argv) {
  const Options o = read_options(argc, argv);
  if (!o.shm.empty()) return talk_by_memory(o);
  if (!o.udp.empty() && !o.names.empty()) return talk_by_udp(o);
  std::fprintf(stderr,
               "usage: railstep_hil_client --udp HOST:PORT --names FILE | --shm NAME\n"
               "  [--input NAME=VALUE]... [--frames N] [--seconds S]\n"
               "Sends these inputs (others 0) for each frame whose outputs come, prints the last\n"
               "outputs. Ends with the run, after N outputs, or S seconds (10) without any.\n");
  return 2;
}
