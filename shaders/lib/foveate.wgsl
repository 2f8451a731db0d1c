// Twin of src/kernel/foveate.rs.
