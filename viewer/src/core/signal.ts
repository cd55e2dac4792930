/// A value that tells when it changes.

export class Signal<T> {
  private readonly listeners: ((value: T) => void)[] = [];

  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set value(next: T) {
    if (next !== this.current) {
      this.current = next;
      this.listeners.forEach((listener) => listener(next));
    }
  }

  /// Calls the listener at once, and after each change.
  subscribe(listener: (value: T) => void): void {
    this.listeners.push(listener);
    listener(this.current);
  }
}
