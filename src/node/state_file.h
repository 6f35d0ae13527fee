#pragma once

#include "flute_grinder/base/escaped.h"
#include "node/disk_thread.h"
#include "node/state_fields.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace grinder {

/// An error of a state file that cannot be read or written; what() names the file and the reason, and is escaped(),
/// because a damaged file may contain anything.
class StateFileError : public std::runtime_error {
 public:
  explicit StateFileError(const std::string& text) : std::runtime_error(escaped(text)) {}
};

/// The error of a state file whose contents are not as they were written.
class StateFileDamaged : public StateFileError {
 public:
  using StateFileError::StateFileError;
};

/// The error of a state file in use by another process; what() names its node and process.
class StateFileOwned : public StateFileError {
 public:
  using StateFileError::StateFileError;
};

/// Keeps a text on disk, so that it survives a crash and a power failure. The file is always either the old or the new
/// version, complete; a damaged or modified file is refused. Once its folder is found, only one SealedFile on
/// the computer owns the file: it locks a file beside it with the suffix `.lock`, which is never removed. Not thread
/// safe; blocks on the disk.
class SealedFile {
 public:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  /// @param kind what the file is, for messages, e.g. "journal".
  /// @param path the file; missing folders are created, symbolic links are followed.
  /// @param owner the resolved name of the node.
  SealedFile(std::string kind, std::string path, std::string owner);

  /// The text written last; nothing if there is no file.
  /// @throw StateFileOwned @throw StateFileDamaged if the file is not complete, as write() wrote it.
  /// @throw StateFileError if it cannot be read.
  std::optional<std::string> read();

  /// Returns once the text and the folder's entry are on the disk, so that a power failure cannot bring back the old
  /// text.
  /// @param undo whether to restore the old file if only the folder cannot be synchronized; what() says if this fails.
  /// @throw StateFileError
  void write(const std::string& text, bool undo);

  /// Rethrows any other error of an action as an Error that names the file.
  template <typename Error = StateFileError, typename Action>
  auto named(const Action& action) const {
    try {
      return action();
    } catch (const StateFileError&) {
      throw;
    } catch (const std::exception& error) {
      throw Error(kind_ + " " + path_ + ": " + error.what());
    }
  }

 private:
  void acquire();

  const std::string kind_, path_, owner_;
  std::string file_;                 ///< the path without symbolic links, once it is owned
  File lock_{nullptr, std::fclose};  ///< held while not null
};

/// How a state is kept: `kKind`, see SealedFile; `kComment`, a note for readers of the file; `kInBackground`, whether a
/// thread of its own writes it, or else the caller of change(); `visit`, the table of StateFields.
template <typename State>
struct StateForm;

/// Keeps a small state on disk, as SealedFile keeps its text. The status is thread safe, and never waits for the disk.
template <typename State>
class StateFile {
 public:
  struct Status {
    State on_disk{};           ///< state that a restart would find
    std::uint64_t number = 0;  ///< number of the last write() that succeeded or failed; 0 before the first
    std::string error;         ///< error of the last write, or of the initial read; empty if none
    std::string damage;        ///< damage found when the file was read, until it is replaced; empty if none
    std::string unread;        ///< why the file could not be read at the start, until it is replaced; empty if it could
  };

  /// Reads the file. Blocks on the disk. A thread of its own ends as DiskThread does: if the disk is dead by then, the
  /// file holds either its old contents or the last write, and stays owned until the disk answers or the process ends.
  /// @param path, owner see SealedFile.
  /// @throw StateFileOwned
  StateFile(std::string path, const std::string& owner) : work_(std::make_shared<Work>(std::move(path), owner)) {
    if (Form::kInBackground) thread_.emplace();
  }

  /// Queues a state to be written, and returns at once; for states that hold whether or not they can be written. While
  /// the disk is busy, a new write replaces the pending one. A file that could not be read is never overwritten. Thread
  /// safe; not for the control thread.
  /// @return the number of this write, from 1.
  std::uint64_t write(const State& state) {
    static_assert(Form::kInBackground);
    const std::lock_guard<std::mutex> lock(work_->mutex);
    if (!work_->pending) thread_->post([work = work_] { work->storePending(); });
    work_->pending = state;
    return ++work_->writes;
  }

  /// Writes the state, and returns once it is on the disk. If it throws, the file is as before, unless what() says
  /// otherwise. A file that could not be read is never overwritten. For one thread.
  /// @throw StateFileError
  void change(const State& state) {
    static_assert(!Form::kInBackground);
    const std::string error = work_->store(state, 0);
    if (!error.empty()) throw StateFileError(error);
  }

  Status status() const {
    const std::lock_guard<std::mutex> lock(work_->mutex);
    return work_->status;
  }

 private:
  using Form = StateForm<State>;

  /// Shared with the thread, which outlives this object if the disk is dead.
  struct Work {
    Work(std::string path, const std::string& owner) : file(Form::kKind, std::move(path), owner) {
      try {
        const std::optional<std::string> text = file.read();
        if (!text) return;
        status.on_disk =
            file.template named<StateFileDamaged>([&] { return StateFields::read<State>(*text, Form::visit); });
      } catch (const StateFileOwned&) {
        throw;
      } catch (const StateFileDamaged& error) {
        status.error = status.damage = error.what();
      } catch (const StateFileError& error) {
        status.error = status.unread = error.what();
      }
    }

    /// Writes a state. @return why it is not on the disk; empty if it is.
    std::string store(const State& state, std::uint64_t number) {
      std::string error;
      try {
        // Only the thread that stores changes the status.
        if (!status.unread.empty() && file.read()) {
          throw StateFileError(status.unread + "; it can be read now: start the grinder again");
        }
        file.write(file.named([&] { return StateFields::write(Form::kComment, state, Form::visit); }),
                   !Form::kInBackground);
      } catch (const std::exception& failed) {
        error = failed.what();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      if (error.empty()) status = {state, 0, "", "", ""};
      status.number = number;
      status.error = error;
      return error;
    }

    void storePending() {
      std::unique_lock<std::mutex> lock(mutex);
      const State state = std::move(*pending);
      pending.reset();
      const std::uint64_t number = writes;
      lock.unlock();
      store(state, number);
    }

    SealedFile file;   ///< used only by the thread that stores
    std::mutex mutex;  ///< guards everything below; held only to copy
    Status status;
    std::uint64_t writes = 0;
    std::optional<State> pending;
  };

  const std::shared_ptr<Work> work_;
  std::optional<DiskThread> thread_;
};

}  // namespace grinder
