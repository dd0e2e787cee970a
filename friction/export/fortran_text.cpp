#include "friction/export/fortran_text.h"

#include <fmt/format.h>

namespace heddle::friction {

const char* const fortran_modules = R"(c     A number with its slopes to slip speed, pressure, fabric and tool
c     temperature: sums, products and functions carry them along.
      module heddle_sens
      implicit none
      private
      public :: sens, var, mapped, operator(+), operator(-)
      public :: operator(*), operator(/), operator(**)
      public :: exp, log, sqrt
      type sens
        double precision :: v = 0.0D0
        double precision :: d(4) = 0.0D0
      end type sens
      interface operator(+)
        module procedure add_ss, add_rs, add_sr
      end interface
      interface operator(-)
        module procedure sub_ss, sub_rs, sub_sr
      end interface
      interface operator(*)
        module procedure mul_ss, mul_rs, mul_sr
      end interface
      interface operator(/)
        module procedure div_ss, div_rs, div_sr
      end interface
      interface operator(**)
        module procedure pow_sr
      end interface
      interface exp
        module procedure exp_s
      end interface
      interface log
        module procedure log_s
      end interface
      interface sqrt
        module procedure sqrt_s
      end interface
      contains
c     The k-th variable at the value x.
      type(sens) function var(k, x)
      integer, intent(in) :: k
      double precision, intent(in) :: x
      var%v = x
      var%d = 0.0D0
      var%d(k) = 1.0D0
      end function var
c     f(x) of known value f and slope df at x.
      type(sens) function mapped(x, f, df)
      type(sens), intent(in) :: x
      double precision, intent(in) :: f, df
      mapped%v = f
      mapped%d = df * x%d
      end function mapped
      type(sens) function add_ss(a, b)
      type(sens), intent(in) :: a, b
      add_ss%v = a%v + b%v
      add_ss%d = a%d + b%d
      end function add_ss
      type(sens) function add_rs(a, b)
      double precision, intent(in) :: a
      type(sens), intent(in) :: b
      add_rs%v = a + b%v
      add_rs%d = b%d
      end function add_rs
      type(sens) function add_sr(a, b)
      type(sens), intent(in) :: a
      double precision, intent(in) :: b
      add_sr%v = a%v + b
      add_sr%d = a%d
      end function add_sr
      type(sens) function sub_ss(a, b)
      type(sens), intent(in) :: a, b
      sub_ss%v = a%v - b%v
      sub_ss%d = a%d - b%d
      end function sub_ss
      type(sens) function sub_rs(a, b)
      double precision, intent(in) :: a
      type(sens), intent(in) :: b
      sub_rs%v = a - b%v
      sub_rs%d = -b%d
      end function sub_rs
      type(sens) function sub_sr(a, b)
      type(sens), intent(in) :: a
      double precision, intent(in) :: b
      sub_sr%v = a%v - b
      sub_sr%d = a%d
      end function sub_sr
      type(sens) function mul_ss(a, b)
      type(sens), intent(in) :: a, b
      mul_ss%v = a%v * b%v
      mul_ss%d = b%v * a%d + a%v * b%d
      end function mul_ss
      type(sens) function mul_rs(a, b)
      double precision, intent(in) :: a
      type(sens), intent(in) :: b
      mul_rs%v = a * b%v
      mul_rs%d = a * b%d
      end function mul_rs
      type(sens) function mul_sr(a, b)
      type(sens), intent(in) :: a
      double precision, intent(in) :: b
      mul_sr%v = a%v * b
      mul_sr%d = b * a%d
      end function mul_sr
      type(sens) function div_ss(a, b)
      type(sens), intent(in) :: a, b
      div_ss%v = a%v / b%v
      div_ss%d = (a%d - div_ss%v * b%d) / b%v
      end function div_ss
      type(sens) function div_rs(a, b)
      double precision, intent(in) :: a
      type(sens), intent(in) :: b
      div_rs%v = a / b%v
      div_rs%d = -div_rs%v * b%d / b%v
      end function div_rs
      type(sens) function div_sr(a, b)
      type(sens), intent(in) :: a
      double precision, intent(in) :: b
      div_sr%v = a%v / b
      div_sr%d = a%d / b
      end function div_sr
c     a > 0
      type(sens) function pow_sr(a, b)
      type(sens), intent(in) :: a
      double precision, intent(in) :: b
      pow_sr%v = a%v**b
      pow_sr%d = b * pow_sr%v / a%v * a%d
      end function pow_sr
      type(sens) function exp_s(a)
      type(sens), intent(in) :: a
      exp_s%v = exp(a%v)
      exp_s%d = exp_s%v * a%d
      end function exp_s
      type(sens) function log_s(a)
      type(sens), intent(in) :: a
      log_s%v = log(a%v)
      log_s%d = a%d / a%v
      end function log_s
      type(sens) function sqrt_s(a)
      type(sens), intent(in) :: a
      sqrt_s%v = sqrt(a%v)
      sqrt_s%d = 0.5D0 / sqrt_s%v * a%d
      end function sqrt_s
      end module heddle_sens

c     Smooth monotone curve: cubic between its points, straight beyond.
      module heddle_curve
      use heddle_sens
      implicit none
      private
      public :: curve
      contains
      type(sens) function curve(n, x, y, s, at)
      integer, intent(in) :: n
      double precision, intent(in) :: x(n), y(n), s(n)
      type(sens), intent(in) :: at
      integer :: i, low, high, middle
      double precision :: h, t, rise, a, b, c
      if (at%v .le. x(1)) then
        curve = mapped(at, y(1) + s(1) * (at%v - x(1)), s(1))
        return
      end if
      if (at%v .ge. x(n)) then
        curve = mapped(at, y(n) + s(n) * (at%v - x(n)), s(n))
        return
      end if
      low = 1
      high = n
      do while (high - low .gt. 1)
        middle = (low + high) / 2
        if (x(middle) .le. at%v) then
          low = middle
        else
          high = middle
        end if
      end do
      i = low
      h = x(i+1) - x(i)
      t = (at%v - x(i)) / h
      rise = y(i+1) - y(i)
      a = s(i) * h
      c = a + s(i+1) * h - 2.0D0 * rise
      b = rise - a - c
      curve = mapped(at, y(i) + t * (a + t * (b + t * c)),
     &               (a + t * (2.0D0 * b + 3.0D0 * t * c)) / h)
      end function curve
      end module heddle_curve

)";

std::string fortran_number(double value) {
  std::string text = fmt::format("{}", value);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
    text += "D0";
  else
    text[exponent] = 'D';
  return value < 0.0 ? "(" + text + ")" : text;
}

}  // namespace heddle::friction
