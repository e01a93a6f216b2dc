#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "text/read.h"

/// One input of a fuzzer, as libFuzzer and replay_main.cpp call it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace railstep::fuzz {

/// Prints the rule that was broken and aborts, so that the fuzzer keeps the input.
[[noreturn]] void fail(const char* what);
inline void check(bool holds, const char* what) {
  if (!holds) fail(what);
}

/// Checks that a refusal is one sentence on one line.
void check_sentence(const std::string& text);

/// Whether f() ends without refusing its input. Documented refusals are an InputError, or
/// Failed if a search ended without a result. All other exceptions pass through and end
/// the fuzzer: std::bad_alloc, std::out_of_range, std::invalid_argument ...
template <typename F>
bool accepts(const F& f) {
  try {
    f();
    return true;
  } catch (const InputError& refusal) {
    check_sentence(refusal.what());
  } catch (const Failed& refusal) {
    check_sentence(refusal.what());
  }
  return false;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process in memory or, if there is none, among temporary files. Shipped profiles
/// and vehicles stand beside it as they do beside config/scenes. The process removes it at its end.
const std::filesystem::path& folder();

/// Writes a file into folder(). @returns its path
std::filesystem::path written(const std::string& name, std::string_view bytes);

}  // namespace railstep::fuzz
