/// \file Rows of a CSV file by RFC 4180.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

struct CsvRow {
  std::vector<std::string> fields;
  std::size_t line = 0;  ///< on which the row begins, from 1
};

/// Fields are parted by commas, rows by LF or CRLF; a field in quotation marks may hold either, and
/// a doubled mark stands for one. A byte order mark in front is passed over.
class CsvRows {
 public:
  /// \param text  must outlive this
  /// \param name  of the file, for errors
  CsvRows(std::string_view text, std::string name);

  /// \return false at the end
  /// \throws FileError if a quotation mark is not closed, or text follows one that is
  [[nodiscard]] bool next(CsvRow& row);

 private:
  [[nodiscard]] std::string next_field();
  [[nodiscard]] std::string quoted_field();
  [[nodiscard]] bool at_row_end() const noexcept;
  void pass_row_end() noexcept;

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace touchtrial::device
