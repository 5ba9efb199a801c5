#include "device/replay/csv_rows.hpp"

#include "core/errors.hpp"

#include <utility>

namespace touchtrial::device {

CsvRows::CsvRows(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
}

bool CsvRows::next(CsvRow& row) {
  if (at_ >= text_.size()) return false;
  row.fields.clear();
  row.line = line_;
  row.fields.push_back(next_field());
  while (at_ < text_.size() && text_[at_] == ',') {
    ++at_;
    row.fields.push_back(next_field());
  }
  if (!at_row_end()) {
    throw FileError(one_line(name_ + ", line " + std::to_string(line_) +
                             ": text after a closing quotation mark; put a comma there"));
  }
  pass_row_end();
  return true;
}

std::string CsvRows::next_field() {
  if (at_ < text_.size() && text_[at_] == '"') return quoted_field();
  const std::size_t begin = at_;
  while (!at_row_end() && text_[at_] != ',') ++at_;
  return std::string(text_.substr(begin, at_ - begin));
}

std::string CsvRows::quoted_field() {
  const std::size_t first_line = line_;
  std::string field;
  for (++at_; at_ < text_.size(); ++at_) {
    if (text_[at_] == '\n') ++line_;
    if (text_[at_] == '"') {
      const bool doubled = at_ + 1 < text_.size() && text_[at_ + 1] == '"';
      if (!doubled) {
        ++at_;
        return field;
      }
      ++at_;
    }
    field += text_[at_];
  }
  throw FileError(one_line(name_ + ", line " + std::to_string(first_line) +
                           ": a quotation mark is not closed; the file may be cut off"));
}

bool CsvRows::at_row_end() const noexcept {
  return at_ >= text_.size() || text_[at_] == '\n' ||
         (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n');
}

void CsvRows::pass_row_end() noexcept {
  if (at_ < text_.size() && text_[at_] == '\r') ++at_;
  if (at_ < text_.size()) ++at_;
  ++line_;
}

}  // namespace touchtrial::device
