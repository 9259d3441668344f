// What the player asks for: keys, buttons to hold, a gamepad, or the tilt of a phone.

const KEYS = { w: "ArrowUp", a: "ArrowLeft", s: "ArrowDown", d: "ArrowRight" };
const HELD = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"];
/** Rates at which keys open the throttle, pull the brake and move the stick, and at which these go back [1/s]. */
const RATES = { throttle: [0.7, 3], brake: [1, 4], stick: [1.2, 2] };
/** Most of the brake that a key pulls: all of it is for hands that feel it. */
const KEY_BRAKE = 0.8;
/** Tilt of a phone that is the stick's end [degrees], and a gamepad's dead zone. */
const FULL_TILT = 30;
const DEAD = 0.08;

export class Controls {
  constructor() {
    this.held = new Set();
    this.byKeys = { throttle: 0, brake: 0, stick: 0 };
    this.tilt = null;
    this.wasStart = false;
  }

  /** Listens to keys and buttons. `commands` has what other keys do, `letters` those that stand for arrows. */
  listen(buttons, commands, { restart, letters = KEYS }) {
    const isField = (target) => target.matches("input:not([type=checkbox]), select, #view");
    addEventListener("keydown", (event) => {
      const key = letters[event.key.toLowerCase()] || event.key;
      if (event.ctrlKey || event.metaKey || event.altKey || isField(event.target)) return;
      const command = commands[key.toLowerCase()];
      if (command && !event.repeat) command();
      if (HELD.includes(key)) this.held.add(key);
      if (command || HELD.includes(key)) event.preventDefault();
    });
    addEventListener("keyup", (event) => this.held.delete(letters[event.key.toLowerCase()] || event.key));
    addEventListener("blur", () => this.held.clear());
    for (const button of buttons) {
      const { key } = button.dataset;
      const release = () => this.held.delete(key);
      button.addEventListener("pointerdown", (event) => {
        button.setPointerCapture(event.pointerId);
        this.held.add(key);
      });
      for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, release);
      button.addEventListener("keydown", (event) => { if (event.key === " " || event.key === "Enter") this.held.add(key); });
      button.addEventListener("keyup", release);
      button.addEventListener("contextmenu", (event) => event.preventDefault());
    }
    this.restart = restart;
  }

  /** Shows this button on a device that may tell its tilt. */
  offerTilt(button) {
    if (!matchMedia("(pointer: coarse)").matches || !("DeviceOrientationEvent" in window)) return;
    button.hidden = false;
    button.addEventListener("click", async () => {
      const isAllowed = await this.useTilt().catch(() => false);
      button.textContent = isAllowed ? "Lean: tilt the device" : "The device gives no tilt";
    });
  }

  /** Asks for the device's tilt; false if it is refused. */
  async useTilt() {
    const { requestPermission } = DeviceOrientationEvent;
    if (requestPermission && await requestPermission.call(DeviceOrientationEvent) !== "granted") return false;
    addEventListener("deviceorientation", ({ beta, gamma }) => {
      if (beta === null) return;
      const turn = { 0: gamma, 90: beta, 180: -gamma, 270: -beta, "-90": -beta }[screen.orientation?.angle ?? window.orientation ?? 0];
      this.tilt = Math.max(-1, Math.min(1, turn / FULL_TILT));
    });
    return true;
  }

  /** The commands after so many seconds: throttle and brake from 0 to 1, stick from -1 to 1. */
  after(seconds) {
    const is = (key) => Number(this.held.has(key));
    const aims = { throttle: is("ArrowUp"), brake: KEY_BRAKE * is("ArrowDown"), stick: is("ArrowRight") - is("ArrowLeft") };
    for (const [name, aim] of Object.entries(aims)) {
      const now = this.byKeys[name];
      const rate = RATES[name][aim === 0 || aim * now < 0 ? 1 : 0] * seconds;
      this.byKeys[name] = now + Math.max(-rate, Math.min(rate, aim - now));
    }
    const pad = this.fromGamepad();
    const limited = (value) => Math.max(-1, Math.min(1, value));
    return {
      throttle: Math.max(this.byKeys.throttle, pad.throttle),
      brake: Math.max(this.byKeys.brake, pad.brake),
      stick: limited(this.byKeys.stick + pad.stick + (this.tilt || 0)),
    };
  }

  /** Right trigger throttle, left trigger brake, left stick lean, start restarts. */
  fromGamepad() {
    const pad = navigator.getGamepads?.().find((one) => one?.connected);
    if (!pad) return { throttle: 0, brake: 0, stick: 0 };
    const value = (button) => pad.buttons[button]?.value || 0;
    const isStart = Boolean(pad.buttons[9]?.pressed);
    if (isStart && !this.wasStart) this.restart();
    this.wasStart = isStart;
    const stick = pad.axes[0] || 0;
    return { throttle: value(7), brake: value(6), stick: Math.abs(stick) < DEAD ? 0 : stick };
  }
}
