/// \file Errors reported to the user. Each message is one line: what failed, where, the remedy.
#pragma once

#include <stdexcept>
#include <string>

namespace touchtrial {

/// Base class. `what()` is one line of UTF-8. Messages that are easily confused end with a code in
/// brackets, for instance [unsigned-look].
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A command was called with invalid arguments. Exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A study or subject file violates its schema. The message names the file and the JSON pointer.
/// Exit code 2.
class StudyError : public Error {
 public:
  using Error::Error;
};

/// A file is missing, unreadable, truncated, of the wrong kind, or cannot be written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// A database cannot be opened, belongs to another study, or refuses a write.
class StoreError : public Error {
 public:
  using Error::Error;
};

/// A device is absent, faulty or not calibrated.
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// Evidence fails verification: a chain, seal, key, pack or schedule. Exit code 3.
class VerificationError : public Error {
 public:
  using Error::Error;
};

/// Makes a text safe for a message and for JSON, whatever file name or value it contains.
/// \return `text` on one line of UTF-8 (core/printable.hpp): ASCII's control characters become
///   spaces, other controls `\uNNNN`, and bytes that are not UTF-8 `\xNN`
[[nodiscard]] std::string one_line(const std::string& text);

}  // namespace touchtrial
