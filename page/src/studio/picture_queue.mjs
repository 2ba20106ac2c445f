// SPDX-License-Identifier: MIT
// Loads pictures that are seen, one after the other: the server makes them one by one, and a browser that waits for six of
// them asks it for nothing else.
export class PictureQueue {
  constructor() {
    this.waiting = [];
    this.isHeld = false;
    this.seen = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) if (isIntersecting) { this.seen.unobserve(target); this.waiting.push(target); }
      this.next();
    });
  }

  /** @param picture an img whose data-src is its address */
  add(picture) {
    picture.addEventListener('load', () => this.done(picture));
    picture.addEventListener('error', () => this.done(picture));
    this.seen.observe(picture);
  }

  done(picture) {
    if (this.loading === picture) this.loading = null;
    this.next();
  }

  /** While the server has surfaces to make, no more pictures are begun. */
  hold(isHeld) {
    this.isHeld = isHeld;
    this.next();
  }

  next() {
    if (this.isHeld) return;
    if (this.loading?.isConnected) return;  // One that was taken off the page is not waited for.
    this.waiting = this.waiting.filter(({ isConnected }) => isConnected);
    this.loading = this.waiting.shift();
    if (this.loading) this.loading.src = this.loading.dataset.src;
  }
}
