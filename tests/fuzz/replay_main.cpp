// Runs a fuzzer without libFuzzer: every named file, then mutations of these for a number of
// seconds; each seed gives other mutations. An input that ends the program, or that runs when the
// program is told to end (SIGTERM), is kept in ./failed-<program>.
// Usage: fuzz_<target> [SECONDS [SEED]] FILE_OR_FOLDER...
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "mutate.h"
#include "oracle.h"

extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                             std::size_t most, unsigned seed);

namespace {

using Input = std::vector<std::uint8_t>;
constexpr std::size_t kMost = 16 << 10;  // bytes of an input

Input current;
std::string failed;
std::mt19937_64 bytes_random(1);

/// Keeps the input and lets the signal end the program.
void keep_input(int signal) {
  const int file = open(failed.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
  if (file >= 0 && write(file, current.data(), current.size()) >= 0) close(file);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void add_file(const std::filesystem::path& file, std::vector<Input>& inputs) {
  std::ifstream in(file, std::ios::binary);
  inputs.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
}

/// Reads files in the order of their names, which is the same on every machine.
std::vector<Input> read_corpus(int count, char** names) {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i)
    if (std::filesystem::is_directory(names[i]))
      for (const auto& entry : std::filesystem::directory_iterator(names[i]))
        files.push_back(entry.path());
    else
      files.emplace_back(names[i]);
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  for (const auto& file : files) add_file(file, inputs);
  return inputs;
}

void run(const Input& input) {
  current = input;
  static_cast<void>(LLVMFuzzerTestOneInput(current.data(), current.size()));
}

Input mutated(Input input, unsigned seed) {
  const std::size_t size = std::min(input.size(), kMost);
  input.resize(kMost);
  bytes_random.seed(seed);
  input.resize(LLVMFuzzerCustomMutator != nullptr
                   ? LLVMFuzzerCustomMutator(input.data(), size, kMost, seed)
                   : LLVMFuzzerMutate(input.data(), size, kMost));
  return input;
}

/// Runs mutations of mutations: four on top of each other, for one input after the other.
long run_mutations(const std::vector<Input>& corpus, double seconds, unsigned seed) {
  const auto begin = std::chrono::steady_clock::now();
  long runs = 0;
  for (unsigned round = 0; !corpus.empty(); ++round)
    for (std::size_t i = 0; i < corpus.size(); ++i) {
      Input input = corpus[i];
      for (unsigned depth = 0; depth < 4; ++depth, ++runs) {
        const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - begin;
        if (gone.count() >= seconds) return runs;
        input = mutated(std::move(input),
                        seed * 2654435761u + round * 7919u + static_cast<unsigned>(4 * i) + depth);
        run(input);
      }
    }
  return runs;
}

}  // namespace

/// Changes one to four bytes, or removes or adds some.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  std::mt19937_64& random = bytes_random;
  if (size == 0 || random() % 8 == 0) {
    const std::size_t added = std::min<std::size_t>(1 + random() % 16, most - size);
    for (std::size_t i = 0; i < added; ++i) data[size + i] = static_cast<std::uint8_t>(random());
    return size + added;
  }
  if (random() % 8 == 0) {
    const std::size_t at = random() % size,
                      cut = std::min<std::size_t>(1 + random() % 16, size - at);
    std::copy(data + at + cut, data + size, data + at);
    return size - cut;
  }
  for (std::uint64_t i = 0, n = 1 + random() % 4; i < n; ++i) {
    std::uint8_t& byte = data[random() % size];
    byte = random() % 2 == 0 ? static_cast<std::uint8_t>(random())
                             : static_cast<std::uint8_t>(byte ^ (1u << (random() % 8)));
  }
  return size;
}

int main(int argc, char** argv) {
  failed = "failed-" + std::filesystem::path(argv[0]).filename().string();
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGTERM})
    std::signal(signal, keep_input);
  int first = 1;
  const auto number = [&] {
    char* end = nullptr;
    const double value = first < argc ? std::strtod(argv[first], &end) : 0.;
    if (end == nullptr || *end != '\0') return 0.;
    ++first;
    return value;
  };
  const double seconds = number();
  const auto seed = static_cast<unsigned>(number());
  const std::vector<Input> corpus = read_corpus(argc - first, argv + first);
  for (const Input& input : corpus) run(input);
  const long runs = run_mutations(corpus, seconds, seed);
  std::printf("%zu inputs, %ld mutations\n", corpus.size(), runs);
  return corpus.empty() ? 1 : 0;
}
