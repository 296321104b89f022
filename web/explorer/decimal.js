// Decimal numbers of any number of digits: deep windows are narrower than the spacing of doubles.

const GUARD = 25; // digits kept beyond the width of what is looked at

/** The number `scaled` / 10^`digits`. */
export class Decimal {
  constructor(scaled, digits) {
    this.scaled = scaled;
    this.digits = digits;
  }

  /** Of a decimal text ("-1.25", "3e-40") or of a double, whose shortest decimal text is taken. */
  static from(value) {
    const match = /^\s*([-+]?)(\d*)\.?(\d*)(?:[eE]([-+]?\d{1,4}))?\s*$/.exec(String(value).replace("−", "-"));
    if (!match || match[2] + match[3] === "") throw new RangeError(`${value} is not a number`);
    const [, sign, whole, fraction, exponent] = match;
    const scaled = BigInt(sign + (whole + fraction));
    const digits = fraction.length - Number(exponent ?? 0);
    return digits >= 0 ? new Decimal(scaled, digits) : new Decimal(scaled * power(-digits), 0);
  }

  plus(other) {
    const digits = Math.max(this.digits, other.digits);
    return new Decimal(this.at(digits) + other.at(digits), digits);
  }

  minus(other) {
    return this.plus(new Decimal(-other.scaled, other.digits));
  }

  times(other) {
    return new Decimal(this.scaled * other.scaled, this.digits + other.digits);
  }

  /** The quotient, cut to that many digits after the point. */
  over(other, digits) {
    return new Decimal((this.scaled * power(digits + other.digits)) / (other.scaled * power(this.digits)), digits);
  }

  half() {
    return new Decimal(this.scaled * 5n, this.digits + 1);
  }

  /** This number plus a double times `share`: a step across a window that is `width` wide. */
  moved(width, share) {
    return this.plus(Decimal.from(width * share)).rounded(digitsFor(width));
  }

  /** Rounded to that many digits after the point. */
  rounded(digits) {
    if (digits >= this.digits) return this;
    const unit = power(this.digits - digits);
    const half = this.scaled < 0n ? -unit / 2n : unit / 2n;
    return new Decimal((this.scaled + half) / unit, digits);
  }

  /** The nearest double. */
  toNumber() {
    return Number(`${this.scaled}e${-this.digits}`);
  }

  /** All digits, without zeros at the end. */
  toString() {
    const sign = this.scaled < 0n ? "-" : "";
    const all = (this.scaled < 0n ? -this.scaled : this.scaled).toString().padStart(this.digits + 1, "0");
    const whole = all.slice(0, all.length - this.digits);
    const fraction = all.slice(all.length - this.digits).replace(/0+$/, "");
    return sign + whole + (fraction ? `.${fraction}` : "");
  }

  /** The scaled integer at another number of digits, which must not be smaller. */
  at(digits) {
    return this.scaled * power(digits - this.digits);
  }
}

/** Digits after the point that numbers inside of a window of that width are kept to. */
export function digitsFor(width) {
  return Math.max(0, Math.ceil(-Math.log10(width))) + GUARD;
}

function power(exponent) {
  return 10n ** BigInt(exponent);
}

const known = { digits: -1, value: null };

/** 2 pi to that many digits, by Machin's formula. */
export function turn(digits) {
  if (known.digits < digits) {
    const unit = power(digits + 10);
    const pi = 16n * inverseTangent(5n, unit) - 4n * inverseTangent(239n, unit);
    Object.assign(known, { digits, value: new Decimal(2n * pi, digits + 10) });
  }
  return known.value.rounded(digits);
}

/** unit * arctan(1/n).
 * @param {bigint} n @param {bigint} unit */
function inverseTangent(n, unit) {
  let term = unit / n;
  let sum = term;
  for (let odd = 3n, sign = -1n; term !== 0n; odd += 2n, sign = -sign) {
    term /= n * n;
    sum += (sign * term) / odd;
  }
  return sum;
}
