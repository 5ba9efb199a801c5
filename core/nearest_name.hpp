/// \file The known name nearest to a misspelt one, for messages that say "did you mean".
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace touchtrial {

/// The fewest insertions, deletions, replacements and swaps of neighbouring characters that turn
/// one name into the other (optimal string alignment). Capitals equal small letters, and `_`, `-`
/// and blanks equal each other, because people confuse them without misspelling a word.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// \return the nearest known name, the first if several are equally near; nothing if more than a
///   third of its characters (and more than one) would have to change
[[nodiscard]] std::optional<std::string_view> nearest_name(std::string_view name,
                                                           std::span<const std::string_view> known);

/// The same among names of products and models: dots, dashes and blanks do not count, a name that
/// differs by these alone comes first, then the family of a numbered name; never another number.
[[nodiscard]] std::optional<std::string_view> nearest_product(
    std::string_view name, std::span<const std::string_view> known);

}  // namespace touchtrial
