// How long work tells how far it is, and hears that it should stop.
#pragma once

#include <string>

namespace polar {

class Progress {
 public:
  virtual ~Progress() = default;
  /// `done` of `total` steps of `stage`; called from the thread that runs the registration.
  virtual void step(const std::string& stage, int done, int total) { (void)stage, (void)done, (void)total; }
  /// A line worth a user's attention.
  virtual void note(const std::string& line) { (void)line; }
  /// True when the work should end as soon as its state is consistent.
  virtual bool cancelled() const { return false; }
};

}  // namespace polar
