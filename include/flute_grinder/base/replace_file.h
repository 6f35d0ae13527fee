#pragma once

#include <sys/stat.h>

#include <string>

namespace grinder {

/// Replaces a file's contents, or creates the file, in one step. Before commit() the new contents are invisible, and
/// vanish if the process ends. After it, a reader sees either the old or the new contents, even after a power failure.
/// Mode and owner stay; of a symbolic link, the target is replaced. All members except the destructor throw
/// std::system_error if something fails; the file is then unchanged.
class FileReplacement {
 public:
  explicit FileReplacement(const std::string& path);
  /// For a single writer: mode and owner are as for a new file, and a symbolic link is itself replaced.
  /// @param fresh name of the new contents before commit(); a file of that name, e.g. after a crash, is overwritten.
  FileReplacement(const std::string& path, const std::string& fresh);
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  ~FileReplacement();

  /// Descriptor of the new contents, open for writing.
  int descriptor() const { return descriptor_; }

  /// The file behind all symbolic links.
  const std::string& file() const { return file_; }

  void commit();

 private:
  const std::string file_;
  std::string fresh_;  ///< path of the new contents; empty while they have no name
  struct stat old_ {};
  bool is_new_ = false;
  int descriptor_ = -1;
};

/// Holds off all others that lock the same file before they read it, change it and replace it, in this process and in
/// others. Without it, one of two changes made at once would be lost.
class FileLock {
 public:
  /// Waits for the others. @throw FileError if the file cannot be opened for writing, or is kept for 10 s.
  explicit FileLock(const std::string& path);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  int descriptor_ = -1;
};

/// Replaces the text of a file like FileReplacement; returns once it is on the disk.
/// @throw std::system_error if that fails; the file is then unchanged, unless only its folder could not be
///        synchronized.
void replaceFile(const std::string& path, const std::string& text);

/// Replaces the text of a file for a single writer, see FileReplacement. The new text has the suffix `.new` until it is
/// on the disk; it survives a power failure only once settleFile() has returned.
/// @throw std::system_error if that fails; the file is then unchanged.
void writeFile(const std::string& path, const std::string& text);

/// Synchronizes the folder, so that the file's name on the disk refers to the last text.
/// @throw std::system_error if that fails.
void settleFile(const std::string& path);

}  // namespace grinder
