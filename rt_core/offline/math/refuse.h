#pragma once
#include <stdexcept>
#include <string>

namespace railstep {

/// The name of a message, "E-SUPPORT-03" of an error or "W-RUN-02" of a warning. It stays when the
/// words change; `railstep explain` says more about each. The compiler checks the form.
class MessageId {
 public:
  consteval MessageId(const char* name) : name_(name) {
    if (!well_formed(name)) throw "expected E- or W-, capital letters, - and two digits";
  }
  [[nodiscard]] const char* name() const { return name_; }

 private:
  static constexpr bool digit(char c) { return c >= '0' && c <= '9'; }
  static constexpr bool well_formed(const char* c) {
    if ((c[0] != 'E' && c[0] != 'W') || c[1] != '-') return false;
    const char* const area = c += 2;
    while (*c >= 'A' && *c <= 'Z') ++c;
    return c != area && c[0] == '-' && digit(c[1]) && digit(c[2]) && c[3] == '\0';
  }
  const char* name_;
};

/// "sentence [E-SUPPORT-03]"
inline std::string named(const std::string& sentence, MessageId id) {
  return sentence + " [" + id.name() + "]";
}

/// An exception of the standard library whose text ends with the name of its message.
template <typename Standard>
class WithId : public Standard {
 public:
  WithId(MessageId id, const std::string& sentence)
      : Standard(named(sentence, id)), id_(id), sentence_(sentence) {}
  [[nodiscard]] MessageId id() const { return id_; }
  [[nodiscard]] const std::string& sentence() const { return sentence_; }

 private:
  MessageId id_;
  std::string sentence_;
};

/// Input that cannot be used. The sentence says what was found and what is expected.
using Refused = WithId<std::invalid_argument>;
/// Good input to which no answer was found.
using Failed = WithId<std::runtime_error>;

[[noreturn]] inline void refuse(MessageId id, const std::string& sentence) {
  throw Refused(id, sentence);
}
[[noreturn]] inline void fail(MessageId id, const std::string& sentence) {
  throw Failed(id, sentence);
}

}  // namespace railstep
