// Begins everything, in the order in which the parts build on each other.

const start = () => {
  restore();
  setUpServed();
  setUpPanel();
  setUpInput();
  try {
    loadWritten();
  } catch (error) {
    problem.textContent = error.message;
  }
  if (!state.target) state.target = nextName("");
  // A page that is left within the pause before points are kept.
  window.addEventListener("pagehide", keep.now);
  catchUp();
  show();
};

start();
