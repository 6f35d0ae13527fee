#include "flute_grinder/control/drive_preparation.h"

#include <pthread.h>

#include <chrono>
#include <exception>

namespace grinder {

namespace {

/// Interval at which the thread polls: the loop wakes no thread, because that takes a system call.
constexpr std::chrono::milliseconds kLook{5};

}  // namespace

DrivePreparation::DrivePreparation(Drive& drive) : drive_(drive), thread_([this] { run(); }) {}

DrivePreparation::~DrivePreparation() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  end_.notify_one();
  thread_.join();
}

bool DrivePreparation::begin() noexcept {
  if (state() == State::kPreparing) return false;
  state_.store(State::kPreparing, std::memory_order_release);
  return true;
}

void DrivePreparation::run() {
  pthread_setname_np(pthread_self(), "preparation");
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_.wait_for(lock, kLook, [this] { return ends_; })) {
    if (state() != State::kPreparing) continue;
    lock.unlock();
    prepare();
    lock.lock();
  }
}

void DrivePreparation::prepare() {
  State result = State::kFailed;
  try {
    drive_.prepare();
    result = State::kReady;
  } catch (const std::exception& error) {
    why_ = textOrNone(error);
  } catch (...) {
    why_ = "an exception that is no std::exception";
  }
  state_.store(result, std::memory_order_release);
}

}  // namespace grinder
