#pragma once
#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "text/message.h"
#include "text/range.h"

namespace railstep {

/// One table of a TOML file. Every getter records its key as known, so that `finish` can refuse the
/// rest. Copies are views of the same file. All getters throw InputError,
/// "file:line:col: [table] what was found; what is expected". A getter with `otherwise` returns it
/// where the key is absent; one without requires the key. Within `whole` a getter keeps its error
/// and reading goes on with NaN, the largest integer, the first choice, an empty string or table.
class Table {
 public:
  [[nodiscard]] bool has(std::string_view key) const;  // also marks the key as known
  /// An integer or a float, finite and within `accepted`; a string is refused.
  [[nodiscard]] double number(std::string_view key, const Range& accepted) const;
  [[nodiscard]] double number(std::string_view key, const Range& accepted, double otherwise) const;
  /// A number, or a slope as "1:n".
  [[nodiscard]] double slope(std::string_view key, const Range& accepted, double otherwise) const;
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t least,
                                     std::int64_t most) const;
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most,
                                     std::int64_t otherwise) const;
  [[nodiscard]] bool boolean(std::string_view key) const;
  [[nodiscard]] bool boolean(std::string_view key, bool otherwise) const;
  /// A string, not empty.
  [[nodiscard]] std::string string(std::string_view key) const;
  [[nodiscard]] std::string string(std::string_view key, std::string_view otherwise) const;
  /// One of `names`; returns its index.
  using Names = std::initializer_list<std::string_view>;
  [[nodiscard]] std::size_t choice(std::string_view key, Names names) const;
  [[nodiscard]] std::size_t choice(std::string_view key, Names names, std::size_t otherwise) const;
  /// `count` of them: one name stands for all, an array has one each.
  [[nodiscard]] std::vector<std::size_t> choices(std::string_view key, Names names,
                                                 std::size_t count, std::size_t otherwise) const;
  /// A path, relative to the folder of the file it stands in (from --set too).
  [[nodiscard]] std::filesystem::path path(std::string_view key) const;
  /// An array of `least` to `most` numbers.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const Range& accepted,
                                            std::size_t least = 1,
                                            std::size_t most = 100'000) const;
  /// Two numbers: one number stands for both, an array has two.
  [[nodiscard]] std::array<double, 2> number_or_pair(std::string_view key,
                                                     const Range& accepted) const;
  /// An array of `least` to `most` strings.
  [[nodiscard]] std::vector<std::string> strings(std::string_view key, std::size_t least,
                                                 std::size_t most) const;
  /// An array of rows of `columns` finite numbers each, [[a, b], ...], at least one row.
  /// @returns row after row, [rows * columns]
  [[nodiscard]] std::vector<double> rows(std::string_view key, std::size_t columns) const;
  [[nodiscard]] Table table(std::string_view key) const;  // required
  [[nodiscard]] std::optional<Table> table_if(std::string_view key) const;
  /// [[key]], in the file's order; empty where absent.
  [[nodiscard]] std::vector<Table> tables(std::string_view key) const;

  /// Throws InputError at `key` (at the table where the key is absent):
  /// "place: [table] `sentence`".
  [[noreturn]] void refuse(std::string_view key, MessageId id, std::string_view sentence) const;
  /// Refuses, here and in all tables below that were opened, each key that no getter asked for and
  /// names the nearest known one. Call once, on the root, after everything was read.
  void finish() const;

  /// Calls `read` on this root and throws all errors together, in the file's order: bad values, the
  /// refusals that were kept and the one that ended `read`, and unknown keys. A refusal behind a
  /// bad value may follow from the number that replaces it, and is dropped.
  /// @param keys  all that this root may have. Beside another error none of them is unknown, since
  ///   the reader that asks for it may have been left out. Without them unknown keys are told only
  ///   where `read` came to its end.
  template <typename Read>
  auto whole(Read read, Names keys = {}) const {
    collect();
    auto result = [&] {
      try {
        return read(*this);
      } catch (const Ended&) {
        throw_kept(true, keys);
        throw;
      } catch (const InputError& last) {
        static_cast<void>(keep(last));
        throw_kept(true, keys);
        throw;
      } catch (const std::exception&) {
        throw_faults();
        throw;
      }
    }();
    throw_kept(false, keys);
    return result;
  }
  /// Within `whole` keeps the refusal that ends `part`, so that reading goes on behind it.
  /// @param tables  the keys of this table below which `part` reads keys that no other part reads:
  ///   where it does not come to its end, unknown keys are not told there
  /// @param known   whether all that `part` builds on was read; where not, it is left out
  /// @returns whether it was read and nothing in it was refused
  template <typename Part>
  bool attempt(Names tables, Part part, bool known = true) const {
    const std::size_t before = refused();
    if (!known || !comes_to_end(part))
      for (const std::string_view key : tables) leave_open(key);
    return known && refused() == before;
  }
  /// An attempt that nothing behind it builds on, or whose result the caller drops where it met an
  /// error: a bad value in it does not drop the refusals behind it.
  /// @returns whether it was read and met no error
  template <typename Part>
  bool attempt_alone(Names tables, Part part, bool known = true) const {
    const bool tainted = is_tainted();
    const std::size_t before = bad_values();
    const bool is_whole = attempt(tables, part, known);
    set_tainted(tainted);
    return is_whole && bad_values() == before;
  }
  /// Calls `read` on each table of [[key]], in the file's order, each one an attempt.
  /// @returns whether nothing in them was refused
  template <typename Read>
  bool each(std::string_view key, Read read) const {
    const std::size_t before = refused();
    for (const Table& entry : tables(key)) {
      const auto part = [&] { read(entry); };
      if (!comes_to_end(part)) entry.leave_open();
    }
    return refused() == before;
  }
  /// Within `whole` ends the attempt around it, or all of the reading, behind a refusal that was
  /// kept: what follows needs what was refused.
  [[noreturn]] void end_part() const;
  /// Within `whole` says that the key is known, and that the keys of the tables in it are not.
  void leave_open(std::string_view key) const;
  /// Within `whole`: refusals are dropped from here on, since a bad value came before.
  [[nodiscard]] bool is_tainted() const;

  [[nodiscard]] std::string name() const;  // "rail.constants", "load[1]"; root: ""
  [[nodiscard]] const std::filesystem::path& file() const;
  /// SHA-256 in hexadecimal of the file's text with, a line each, what was set over it.
  [[nodiscard]] const std::string& sum() const;

 private:
  friend Table read_toml(const std::filesystem::path&, const std::vector<std::string>&);
  friend Table read_toml_text(std::string_view, const std::filesystem::path&,
                              const std::vector<std::string>&);
  struct View;   // the document and the table in it
  struct Entry;  // one key of it, with the checks the getters share
  [[nodiscard]] Entry look_up(std::string_view key) const;  // marks the key as known
  [[nodiscard]] Entry need(std::string_view key) const;     // and throws where it is absent
  /// read(entry of the key), or `otherwise` after an error that `whole` keeps.
  template <typename Read, typename Value>
  Value kept(std::string_view key, Read read, Value otherwise) const;
  struct Ended {};  // thrown by end_part()
  /// Whether `part` came to its end. Otherwise its refusal is kept.
  template <typename Part>
  bool comes_to_end(Part& part) const {
    try {
      part();
      return true;
    } catch (const Ended&) {
      return false;
    } catch (const InputError& error) {
      if (!keep(error)) throw;
      return false;
    }
  }
  void collect() const;
  [[nodiscard]] bool keep(const InputError& refusal) const;  // false outside of `whole`
  [[nodiscard]] std::size_t refused() const;                 // number of refusals so far
  [[nodiscard]] std::size_t bad_values() const;              // and of bad values
  void set_tainted(bool tainted) const;
  void leave_open() const;                             // this table
  void throw_kept(bool ends_early, Names keys) const;  // all errors, if there are any
  void throw_faults() const;                           // the same without unknown keys
  explicit Table(std::shared_ptr<const View> view) : view_(std::move(view)) {}
  std::shared_ptr<const View> view_;
};

inline constexpr std::size_t kLargestFile = 1u << 20;  // bytes

/// Reads a text file whole. Throws InputError where it is missing, a folder, empty or longer than
/// `most` bytes.
std::string read_text(const std::filesystem::path& file, std::size_t most = kLargestFile);

/// Parses a TOML file, then applies `overrides`, each "key.path=value" with a TOML value and
/// name[i] for the i-th entry of an array, as if written in the file; their errors name the option.
/// Throws InputError on anything that is not one TOML 1.0 document nested at most 32 deep.
Table read_toml(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same on text already read; `file` is the name used in errors and for relative paths.
Table read_toml_text(std::string_view text, const std::filesystem::path& file,
                     const std::vector<std::string>& overrides = {});

/// The text of a TOML file with overrides applied, as it may stand at `place`: names of files,
/// which are relative to the folder of the one they stand in, are made so there. Comments are lost.
std::string rewritten(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                      const std::filesystem::path& place);

/// The entry of `known` nearest to `word` by edit distance, where letters missing at the end of
/// `word` cost an eighth ("stifness" is near "stiffness_z_n_per_m"). Empty if `known` is.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace railstep
