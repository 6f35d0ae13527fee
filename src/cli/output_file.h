#pragma once

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/replace_file.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

namespace grinder {

/// @throw FileError if the command has read this file, by whatever name.
void requireNotRead(const std::string& path);

/// A file that a command writes; all commands write through this class. It is opened before the work begins, and keeps
/// its old contents until close() replaces them in one step. A FIFO, a device and the program's own standard output are
/// written directly.
class OutputFile {
 public:
  /// @throw FileError if the file cannot be written, or if the command has read it or writes it already.
  explicit OutputFile(std::string path);
  ~OutputFile();

  const std::string& path() const { return path_; }
  std::FILE* stream() const { return stream_.get(); }
  /// The argument `DESCRIPTOR:PATH` for a program that inherits the descriptor and writes the file.
  std::string forProgram() const;

  /// @param error errno of a write that failed; 0 if none did.
  /// @throw WriteError if writing failed, FileError if the command has read the file since.
  void close(int error = 0);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::string path_;
  std::optional<FileReplacement> replacement_;  ///< nothing for a FIFO, a device and standard output
  std::unique_ptr<std::FILE, Closer> stream_;
};

/// Opens a file; null for an empty path. @throw FileError
std::unique_ptr<OutputFile> openOutput(const std::string& path);

}  // namespace grinder
