//! Laws of linkages' moves and states, and the planner against unlike methods.
