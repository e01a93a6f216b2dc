#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <typeinfo>

#include "text/read.h"

/// One input of a fuzzer, as libFuzzer and replay_main.cpp call it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace railstep::fuzz {

/// Says what did not hold and aborts, so that the fuzzer keeps the input.
[[noreturn]] void fail(const char* what);
inline void check(bool holds, const char* what) {
  if (!holds) fail(what);
}

/// A refusal is one sentence on one line.
void check_sentence(const std::string& text);

/// Whether f() ends; false where it refuses its input as documented: an InputError, or a
/// std::runtime_error itself where a search ended without what was asked. All else passes through
/// and ends the fuzzer: std::bad_alloc, std::out_of_range, std::invalid_argument ...
template <typename F>
bool accepts(const F& f) {
  try {
    f();
    return true;
  } catch (const InputError& refusal) {
    check_sentence(refusal.what());
  } catch (const std::runtime_error& refusal) {
    if (typeid(refusal) != typeid(std::runtime_error)) throw;
    check_sentence(refusal.what());
  }
  return false;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process in memory or, without such, among temporary files; shipped profiles and
/// vehicles stand beside it as they do beside config/scenes. Gone at the end of the process.
const std::filesystem::path& folder();

/// Writes a file into folder(). @returns its path
std::filesystem::path written(const std::string& name, std::string_view bytes);

}  // namespace railstep::fuzz
