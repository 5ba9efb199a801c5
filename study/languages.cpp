#include "study/languages.hpp"

#include "study/study_sections.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <vector>

namespace touchtrial::study {
namespace {

constexpr std::size_t kMaxTextBytes = 4000;
constexpr std::string_view kBold = "**";
constexpr std::string_view kPictureStart = "![](";
constexpr std::string_view kDrawings = "drawing:";

/// Which texts a file must contain.
enum class Extent { all, some };

/// The English texts, whose keys and marks all other languages must match.
const Texts& english_texts() {
  static const Texts texts = [] {
    Texts english;
    const auto file = nlohmann::json::parse(language_files().front());
    for (const auto& [key, value] : file.items()) {
      if (value.is_object()) english[key] = value.get<std::map<std::string, std::string>>();
    }
    return english;
  }();
  return texts;
}

template <typename Visit>
void for_each_line(std::string_view text, Visit visit) {
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    visit(text.substr(at, end - at));
    at = end + 1;
  }
}

std::vector<std::string> pictures_of(std::string_view text) {
  std::vector<std::string> pictures;
  for_each_line(text, [&](std::string_view line) {
    if (const auto name = picture_in(line); !name.empty()) pictures.emplace_back(name);
  });
  return pictures;
}

/// The words in braces, sorted.
std::vector<std::string> words_in_braces(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = text.find('{'); at < text.size(); at = text.find('{', at + 1)) {
    words.emplace_back(text.substr(at, text.find('}', at) - at + 1));
  }
  std::ranges::sort(words);
  return words;
}

/// Requires a text to have the same marks as the English one.
void check_marks(const JsonValue& place, const std::vector<std::string>& marks,
                 const std::vector<std::string>& english) {
  std::vector<std::string> difference;
  std::ranges::set_difference(english, marks, std::back_inserter(difference));
  if (!difference.empty()) {
    place.refuse("lacks " + in_quotes(difference.front()) +
                 "; write it where it belongs in the text");
  }
  std::ranges::set_difference(marks, english, std::back_inserter(difference));
  if (!difference.empty()) {
    place.refuse("has " + in_quotes(difference.front()) +
                 (english.empty() ? ", which the English text does not have"
                                  : " more often than the English text") +
                 "; remove it");
  }
}

std::string read_text(const JsonValue& place, const std::string& english, Extent extent) {
  std::string text = read_paragraphs(place, kMaxTextBytes);
  if (text.empty()) place.refuse("is empty; write the text");
  check_markup(place, text);
  check_marks(place, words_in_braces(text), words_in_braces(english));
  if (extent == Extent::all) check_marks(place, pictures_of(text), pictures_of(english));
  return text;
}

template <typename Map>
std::vector<std::string_view> keys_of(const Map& map) {
  std::vector<std::string_view> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

std::optional<JsonValue> member_of(const JsonObject& object, const std::string& key,
                                   Extent extent) {
  return extent == Extent::all ? object.at(key) : object.find(key);
}

Texts read_sections(const JsonObject& file, Extent extent) {
  Texts texts;
  for (const auto& [section, english] : english_texts()) {
    const auto member = member_of(file, section, extent);
    if (!member) continue;
    const JsonObject object = member->object(keys_of(english));
    for (const auto& [key, english_text] : english) {
      const auto text = member_of(object, key, extent);
      if (text) texts[section][key] = read_text(*text, english_text, extent);
    }
  }
  return texts;
}

}  // namespace

std::string_view picture_in(std::string_view line) noexcept {
  const bool is_picture = line.starts_with(kPictureStart) && line.ends_with(')');
  if (!is_picture) return {};
  return line.substr(kPictureStart.size(), line.size() - kPictureStart.size() - 1);
}

void check_markup(const JsonValue& place, const std::string& text) {
  int marks = 0;
  for (std::size_t at = text.find(kBold); at != text.npos; at = text.find(kBold, at + 2)) ++marks;
  if (marks % 2 != 0) {
    place.refuse("opens bold text with \"**\" but does not close it; add the closing \"**\"");
  }
  for (const std::string& name : pictures_of(text)) {
    if (name.starts_with(kDrawings) && name != kHandDrawing) {
      place.refuse(in_quotes(name) + " is not a known drawing; use " + in_quotes(kHandDrawing) +
                   " or the path of a picture");
    }
  }
}

Language parse_language(std::string_view text, const std::string& source) {
  std::vector<std::string_view> keys = keys_of(english_texts());
  keys.insert(keys.end(), {"language", "name", "draft"});
  const JsonObject file = parse_strict_json(text, source).object(keys);
  Language language;
  language.code = read_plain_name(file.at("language"));
  language.name = read_line(file.at("name"), kMaxTextBytes);
  language.draft = file.at("draft").boolean();
  language.texts = read_sections(file, Extent::all);
  return language;
}

const Language& language_of(std::string_view code) {
  struct LazyLanguage {
    std::once_flag once;
    Language language;
  };
  static std::vector<LazyLanguage> all(language_codes().size());
  const auto found = std::ranges::find(language_codes(), code.substr(0, 2));
  const std::size_t i = found == language_codes().end()
                            ? 0
                            : static_cast<std::size_t>(found - language_codes().begin());
  std::call_once(all[i].once, [&] {
    all[i].language = parse_language(language_files()[i], "the program's texts");
  });
  return all[i].language;
}

bool has_decimal_comma(std::string_view code) noexcept {
  return code.starts_with("de") || code.starts_with("es") || code.starts_with("fr");
}

Texts read_texts(const JsonValue& place) {
  return read_sections(place.object(keys_of(english_texts())), Extent::some);
}

Texts texts_of(const SessionPlan& session) {
  Texts texts = language_of(session.language).texts;
  const auto replacements = session.texts.find(session.language);
  if (replacements == session.texts.end()) return texts;
  for (const auto& [section, parts] : replacements->second) {
    for (const auto& [key, text] : parts) texts[section][key] = text;
  }
  return texts;
}

std::vector<std::string> picture_files(const SessionPlan& session) {
  std::vector<std::string> files;
  const auto add_pictures = [&files](const std::string& page) {
    for (const std::string& name : pictures_of(page)) {
      if (name != kHandDrawing && std::ranges::count(files, name) == 0) files.push_back(name);
    }
  };
  const auto pages = session.instructions.find(session.language);
  if (pages != session.instructions.end()) std::ranges::for_each(pages->second, add_pictures);
  for (const auto& [section, parts] : texts_of(session)) {
    for (const auto& [key, text] : parts) add_pictures(text);
  }
  return files;
}

std::string draft_notice(std::string_view code) {
  const Language& language = language_of(code);
  if (!language.draft) return "";
  return "the program's texts in " + language.name + " are a draft, not validated";
}

}  // namespace touchtrial::study
