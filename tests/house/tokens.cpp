#include "house/tokens.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <set>
#include <utility>

namespace touchtrial::house {
namespace {

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Without carriage returns, and with every line that ends in a backslash joined to its next.
std::string joined_lines(std::string_view text) {
  std::string joined(text);
  joined.erase(std::remove(joined.begin(), joined.end(), '\r'), joined.end());
  for (std::size_t at = 0; (at = joined.find("\\\n", at)) != std::string::npos;) {
    joined.erase(at, 2);
  }
  joined += '\n';
  return joined;
}

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(joined_lines(text)) {}

  TokensOfFile read() {
    while (at_ < text_.size()) next();
    return {std::move(tokens_), std::move(includes_)};
  }

 private:
  void next() {
    const char c = text_[at_];
    if (c == '\n') {
      if (in_directive_) end_directive();
      line_begins_at_ = tokens_.size();
      ++at_;
    } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at_;
    } else if (starts_with("//")) {
      at_ = text_.find('\n', at_);
    } else if (starts_with("/*")) {
      skip_past("*/");
    } else if (c == '#' && tokens_.size() == line_begins_at_) {
      in_directive_ = true;
      ++at_;
    } else if (in_word(c)) {
      word();
    } else if (c == '"' || c == '\'') {
      literal(c);
    } else {
      sign();
    }
  }

  void word() {
    static const std::set<std::string> raw = {"R", "u8R", "uR", "UR", "LR"};
    const std::size_t from = at_;
    while (in_word(text_[at_]) || separates_digits(from)) ++at_;
    const std::string word = text_.substr(from, at_ - from);
    if (text_[at_] == '"' && raw.count(word) > 0) {
      const std::size_t open = text_.find('(', at_);
      skip_past(")" + text_.substr(at_ + 1, open - at_ - 1) + "\"");
      tokens_.emplace_back("\"\"");
    } else {
      tokens_.push_back(word);
    }
  }

  bool separates_digits(std::size_t from) const {
    return text_[at_] == '\'' && std::isdigit(static_cast<unsigned char>(text_[from])) != 0;
  }

  /// Ends with its line at the latest, as an apostrophe in "#error don't" does.
  void literal(char quote) {
    const std::size_t from = at_;
    for (++at_; text_[at_] != quote && text_[at_] != '\n'; ++at_) {
      if (text_[at_] == '\\' && text_[at_ + 1] != '\n') ++at_;
    }
    if (text_[at_] == quote) ++at_;
    tokens_.push_back(text_.substr(from, at_ - from));
  }

  void sign() {
    static constexpr std::array kLong = {"<=>", "<=", ">=", "<<", "->", "::"};
    const auto* const found =
        std::find_if(kLong.begin(), kLong.end(), [&](const char* s) { return starts_with(s); });
    tokens_.push_back(found == kLong.end() ? std::string(1, text_[at_]) : *found);
    at_ += tokens_.back().size();
  }

  void end_directive() {
    const Tokens words(tokens_.begin() + static_cast<std::ptrdiff_t>(line_begins_at_),
                       tokens_.end());
    in_directive_ = false;
    tokens_.resize(depth_left_out_ > 0 ? kept_ : line_begins_at_);
    if (words.empty()) return;
    const std::string& what = words.front();
    if (depth_left_out_ > 0) {
      if (what.starts_with("if")) ++depth_left_out_;
      if (what == "endif" || (what.starts_with("el") && depth_left_out_ == 1)) --depth_left_out_;
    } else if (words == Tokens{"if", "0"}) {
      depth_left_out_ = 1;
      kept_ = tokens_.size();
    } else if (what == "include") {
      includes_.emplace_back();
      for (std::size_t i = 1; i < words.size(); ++i) includes_.back() += words[i];
    }
  }

  void skip_past(const std::string& end) {
    const std::size_t found = text_.find(end, at_ + 2);
    at_ = found == std::string::npos ? text_.size() : found + end.size();
  }

  bool starts_with(std::string_view what) const {
    return std::string_view(text_).substr(at_).starts_with(what);
  }

  std::string text_;  // ends with a new line
  std::size_t at_ = 0;
  std::size_t line_begins_at_ = 0;  // a number of tokens, as the next but one
  bool in_directive_ = false;
  std::size_t kept_ = 0;  // before "#if 0"
  int depth_left_out_ = 0;
  Tokens tokens_;
  std::vector<std::string> includes_;
};

}  // namespace

TokensOfFile tokens_of(std::string_view text) {
  return Lexer(text).read();
}

bool is_name(const std::string& token) {
  return !token.empty() && in_word(token.front());
}

}  // namespace touchtrial::house
