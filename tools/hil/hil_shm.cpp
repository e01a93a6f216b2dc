#include "hil/hil_shm.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include "text/read.h"

namespace railstep {
namespace {

using Word = SeqLock::Word;
constexpr int kTries = 8;  // a bound on a frame's work, whatever the writer does
constexpr char kShmMagic[] = "railshm1";
constexpr std::size_t kLongestName = 200;

/// The part of the exchange that signal handlers need.
struct Guarded {
  std::atomic<unsigned char*> memory{nullptr};
  std::atomic<std::size_t> bytes{0};
  char file[sizeof "/dev/shm/" + kLongestName] = {};  // written before the memory is announced
};
Guarded guarded;

/// Replaces the pages of a file that was cut short by zeros.
void replace_lost_pages(int, siginfo_t* met, void*) {
  unsigned char* const memory = guarded.memory.load();
  const auto* const at = static_cast<const unsigned char*>(met->si_addr);
  const bool own = memory != nullptr && at >= memory && at < memory + guarded.bytes.load();
  if (!own || mmap(memory, guarded.bytes.load(), PROT_READ | PROT_WRITE,
                   MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED)
    std::signal(SIGBUS, SIG_DFL);  // it is met again at once
}

void guard(const std::string& name, void* memory, std::size_t bytes) {
  std::strcpy(guarded.file, ("/dev/shm/" + name).c_str());
  guarded.bytes = bytes;
  guarded.memory = static_cast<unsigned char*>(memory);
  struct sigaction action {};
  action.sa_sigaction = replace_lost_pages;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

std::uint64_t magic_word() noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, kShmMagic, sizeof word);
  return word;
}

constexpr std::size_t whole_lines(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

std::string path_of(const std::string& name) {
  const bool plain =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
      std::string::npos;
  if (name.empty() || name.size() > kLongestName || !plain || name.front() == '.')
    throw InputError("E-HIL-11",
                     fmt::format("--shm {}: this cannot name shared memory; expected 1 to 200 "
                                 "letters, digits, '.', '_' and '-', not beginning with '.'",
                                 name));
  return "/" + name;
}

/// Memory of all pages, none of which is still to be found when it is written to.
void* mapped(const std::string& name, std::size_t bytes) {
  const std::string path = path_of(name);
  const auto refuse = [&](int reason) {
    throw InputError("E-HIL-12",
                     fmt::format("--shm {}: cannot be made: {}{}", name, std::strerror(reason),
                                 reason == EEXIST ? "; another run has it, or one that was killed "
                                                    "left it in /dev/shm"
                                                  : ""));
  };
  const int file = shm_open(path.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
  if (file < 0) refuse(errno);
  const int reserved = posix_fallocate(file, 0, static_cast<off_t>(bytes));
  void* const memory = reserved == 0
                           ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0)
                           : MAP_FAILED;
  const int reason = reserved == 0 ? errno : reserved;
  close(file);
  if (memory != MAP_FAILED) return memory;
  shm_unlink(path.c_str());
  refuse(reason);
  return nullptr;
}

SeqLock block(void* memory, std::size_t at, std::size_t words) noexcept {
  return {reinterpret_cast<Word*>(static_cast<unsigned char*>(memory) + at), words};
}

}  // namespace

SharedExchange::SharedExchange(const std::string& name, const ExchangeLayout& layout)
    : name_(name),
      in_(kBlockHead + layout.inputs.size()),
      out_(kBlockHead + layout.outputs.size()),
      value_(layout.inputs.size()) {
  std::string names;
  for (const auto* const of : {&layout.inputs, &layout.outputs})
    for (const std::string& each : *of) names += each + '\n';
  inputs_at_ = whole_lines(8 * kSharedHead);
  outputs_at_ = inputs_at_ + whole_lines(8 * (kBlockLock + in_.size()));
  const std::size_t names_at = outputs_at_ + whole_lines(8 * (kBlockLock + out_.size()));
  bytes_ = names_at + names.size();
  memory_ = mapped(name, bytes_);
  guard(name, memory_, bytes_);
  lay_out(layout, names);
}

void SharedExchange::lay_out(const ExchangeLayout& layout, const std::string& names) {
  auto* const bytes = static_cast<unsigned char*>(memory_);
  auto* const word = reinterpret_cast<Word*>(memory_);
  for (std::size_t i = 0; i < (bytes_ - names.size()) / 8; ++i) new (word + i) Word(0);
  const std::size_t names_at = bytes_ - names.size();
  std::copy(names.begin(), names.end(), bytes + names_at);
  const std::uint64_t head[kSharedHead] = {
      magic_word(), 0,        layout.inputs.size(), layout.outputs.size(), inputs_at_,
      outputs_at_,  names_at, names.size()};
  for (std::size_t i = 0; i < kSharedHead; ++i) word[i].store(head[i], std::memory_order_relaxed);
  word[1].store(1, std::memory_order_release);
}

SharedExchange::~SharedExchange() {
  guarded.memory = nullptr;
  munmap(memory_, bytes_);
  shm_unlink(("/" + name_).c_str());
}

const double* SharedExchange::inputs(std::int64_t frame) noexcept {
  const SeqLock from = block(memory_, inputs_at_, in_.size());
  if (from.number() == seen_) return nullptr;
  if (!from.read(in_.data(), kTries, seen_)) {
    ++counts_.torn;
    return nullptr;
  }
  if (lost()) return nullptr;  // after the reading: zeros are not inputs
  ++counts_.fresh;
  const auto meant = static_cast<std::int64_t>(in_[1]);
  if (meant >= 0 && meant < frame) ++counts_.late;
  for (std::size_t i = 0; i < value_.size(); ++i)
    value_[i] = std::bit_cast<double>(in_[kBlockHead + i]);
  return value_.data();
}

void SharedExchange::outputs(const FrameOutputs& made) noexcept {
  out_[0] = ++sequence_;
  out_[1] = static_cast<std::uint64_t>(made.frame);
  out_[2] = static_cast<std::uint64_t>(made.status) | static_cast<std::uint64_t>(made.flags) << 32;
  for (std::size_t i = kBlockHead; i < out_.size(); ++i)
    out_[i] = std::bit_cast<std::uint64_t>(made.values[i - kBlockHead]);
  block(memory_, outputs_at_, out_.size()).write(out_.data());
}

bool SharedExchange::lost() const noexcept {
  return static_cast<const Word*>(memory_)->load(std::memory_order_acquire) != magic_word();
}

void SharedExchange::unlink_at_once() noexcept {
  if (guarded.memory.load() != nullptr) unlink(guarded.file);
}

}  // namespace railstep
