// The next step H and the number k of columns of its tableau, at the least work for the time: what
// T_kk and T_k,k-1 differ by goes with H^(p (k - 1) + 1), where the error has powers of h^p; over
// the time, with one power less.
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.9.
#pragma once

#include <limits>

namespace physics {

class Archive;

// A frame's steps may err by this part of the accuracy: errors add up, and grow with the motion.
inline constexpr double kShareOfFrame = 0.01;

class StepChoice {
 public:
  // Rows of a tableau are made one after the other, or side by side (lane_rows.h). All here is told
  // of rows of 1, 2, ... steps.
  enum class Rows : char { kInTurn, kSideBySide };
  // Of a step: what the accuracy allows, which goes with it to the power `grows`, but no less than
  // what numbers leave of it, which goes with it to the power -falls.
  struct Allowance {
    double error;
    int grows = 0;
    double finest = 0;
    int falls = 0;
    double most() const { return error > finest ? error : finest; }
  };
  // With no fewer than `least` columns, and no more than `most`.
  StepChoice(int power, int least, int most, Rows rows)
      : power_(power), least_(least), most_(most), columns_(least), rows_(rows) {}

  int columns() const { return columns_; }
  // s: all of `time`, where nothing is known.
  double wanted(double time) const { return wanted_ > 0 ? wanted_ : time; }
  // That, of what is left of it.
  double next(double left, double time) const;
  // One more column, for the step that is being made. False: there are no more.
  bool extend() { return columns_ < most_ && ++columns_ > 0; }
  // A step that errs by too much; an infinite error is one that failed.
  void reject(double step, double error, const Allowance& allowed);
  // `coarser`: the error of one column less.
  void accept(double step, double error, double coarser, const Allowance& allowed, double time);
  // What rests is resolved by any step.
  void rest() {
    resolves_ = true;
    lost_ = 0;
  }
  // A step that is kept, whatever it errs by. `lost`: that, where no step resolves the motion.
  void giveUp(double lost) {
    resolves_ = rejected_ = false;
    lost_ = lost;
  }
  // The same of what has no powers of h. Neither shorter steps nor more columns are tried again
  // until a whole frame is resolved as it is: what has been lost they do not bring back.
  void takeAsItIs() {
    giveUp(0);
    forget();
    columns_ = least_;
    isRough_ = true;
  }
  bool isRough() const { return isRough_; }
  // What the last step erred by, where none resolves it; 0: one may.
  double lost() const { return lost_; }
  // The last step erred by no more than was allowed.
  bool resolves() const { return resolves_; }
  void forget() {
    rejected_ = false;
    wanted_ = 0;
    bound_ = std::numeric_limits<double>::infinity();
  }
  void archive(Archive& a);

 private:
  double workFor(double step, int columns, double time) const;
  double stepFor(double step, double error, int columns, const Allowance& allowed) const;
  int power_, least_, most_, columns_;
  Rows rows_;
  bool resolves_ = false;
  bool rejected_ = false;  // the step before, in the same frame
  bool isRough_ = false;
  double lost_ = 0;
  double wanted_ = 0;                                       // [s]; 0: not known
  double bound_ = std::numeric_limits<double>::infinity();  // longer ones failed [s]
};

// The n-th root of 0 < x, the same on every machine.
double rootOf(double x, int n);

}  // namespace physics
