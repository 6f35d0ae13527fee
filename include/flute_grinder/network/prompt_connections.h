#pragma once

namespace grinder {

/// Makes connections between topics soon: roscpp's XML-RPC thread looks for new work only 10 times a second, and needs
/// three such looks for a subscriber. It looks 100 times a second from now on. To be called before ros::start().
/// @throw std::system_error
void connectPromptly();

}  // namespace grinder
