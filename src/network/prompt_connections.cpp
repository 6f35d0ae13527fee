#include "flute_grinder/network/prompt_connections.h"

#include <ros/xmlrpc_manager.h>
#include <sys/timerfd.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcDispatch.h>
#include <xmlrpcpp/XmlRpcSource.h>
#include <boost/make_shared.hpp>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace grinder {

namespace {

constexpr long kPeriod = 10'000'000;  ///< [ns]

/// Looks to roscpp like a connection, and has its thread leave off waiting for events at every tick of a clock.
class Ticks final : public ros::ASyncXMLRPCConnection, public XmlRpc::XmlRpcSource {
 public:
  Ticks() : XmlRpcSource(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    const itimerspec period{{0, kPeriod}, {0, kPeriod}};
    if (getfd() < 0 || timerfd_settime(getfd(), 0, &period, nullptr) != 0) {
      throw std::system_error(errno, std::generic_category(), "the clock of the XML-RPC thread");
    }
  }
  ~Ticks() override { ::close(getfd()); }

  void addToDispatch(XmlRpc::XmlRpcDispatch* dispatch) override {
    dispatch_ = dispatch;
    dispatch->addSource(this, XmlRpc::XmlRpcDispatch::ReadableEvent);
  }
  void removeFromDispatch(XmlRpc::XmlRpcDispatch* dispatch) override { dispatch->removeSource(this); }
  bool check() override { return false; }  // never done

  unsigned handleEvent(unsigned /*event*/) override {
    std::uint64_t ticks = 0;
    if (read(getfd(), &ticks, sizeof ticks) > 0) dispatch_->exit();
    return XmlRpc::XmlRpcDispatch::ReadableEvent;
  }

 private:
  XmlRpc::XmlRpcDispatch* dispatch_ = nullptr;
};

}  // namespace

void connectPromptly() { ros::XMLRPCManager::instance()->addASyncConnection(boost::make_shared<Ticks>()); }

}  // namespace grinder
