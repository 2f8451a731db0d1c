//#use wrs
